"""Modules of the panel form no circle, not even by imports that only types need.

The layers of its rooms are contracts of `make lint`, which leaves such imports out.
"""

import grimp


def test_no_module_of_the_panel_needs_one_that_needs_it() -> None:
    graph = grimp.build_graph("openacr", exclude_type_checking_imports=False, cache_dir=None)
    panel = sorted(name for name in graph.modules if name.startswith("openacr.panel."))
    assert len(panel) > 50
    circles = [
        (name, needed)
        for name in panel
        for needed in sorted(graph.find_modules_directly_imported_by(name))
        if graph.find_shortest_chain(needed, name)
    ]
    assert circles == []
