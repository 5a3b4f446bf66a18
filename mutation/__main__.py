"""Break the source place by place and list what no test notices.

Without a name the lines changed since --base are tried, else whole packages or files below
src/openacr, or `all`. The cases of the manuals come first: they are quick. Core modules (*_cy.py)
run as plain Python, whatever is compiled.
"""

import argparse
import json
import random
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import SimpleQueue

from rich.console import Console
from rich.progress import track

from mutation.changes import changed, named
from mutation.operators import Mutant, mutants
from mutation.reach import Reach, folders_of, measure
from mutation.trial import Tree, Verdict

WORK = Path("build/mutation").absolute()
EQUAL = Path(__file__).with_name("equal.txt")
LOST = (Verdict.SURVIVED, Verdict.UNREACHED)


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m mutation", description=__doc__)
    parser.add_argument("what", nargs="*", help="packages or files below src/openacr")
    parser.add_argument("--base", default="HEAD~1", help="revision since which lines are changed")
    parser.add_argument("--most", type=int, default=0, help="mutants drawn at random (0: all)")
    parser.add_argument(
        "--each", type=int, default=0, help="mutants drawn at random from each package (0: all)"
    )
    parser.add_argument("--seed", type=int, default=1, help="of the draw")
    parser.add_argument(
        "--tests", nargs="+", help="folders of tests instead of those of the package"
    )
    parser.add_argument("--within", type=float, default=30.0, help="seconds of tests per mutant")
    parser.add_argument("--percent", type=float, default=10.0, help="survivors that are let pass")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--json", type=Path, help="write every verdict to this file")
    return parser.parse_args()


def _equal() -> tuple[str, ...]:
    lines = EQUAL.read_text().splitlines()
    return tuple(line.partition(" # ")[0] for line in lines if line and not line.startswith("#"))


def _place(mutant: Mutant) -> str:
    """A mutant without its line number, as `equal.txt` names it."""
    path, _, rest = str(mutant).partition(" ")
    return f"{path.rpartition(':')[0]} {rest}"


def _chosen(options: argparse.Namespace) -> list[Mutant]:
    lines = named(options.what) if options.what else changed(options.base)
    equal = _equal()
    found = [
        mutant
        for path, numbers in lines.items()
        for mutant in mutants(path, Path(path).read_text())
        if (numbers is None or mutant.line in numbers) and _place(mutant) not in equal
    ]
    draw = random.Random(options.seed)
    if options.each:
        groups: dict[str, list[Mutant]] = {}
        for mutant in found:
            groups.setdefault(_package(mutant), []).append(mutant)
        found = [each for group in groups.values() for each in _drawn(draw, group, options.each)]
    return _drawn(draw, found, options.most) if options.most else found


def _drawn(draw: random.Random, found: list[Mutant], most: int) -> list[Mutant]:
    """Some of the mutants, in their order."""
    places = sorted(draw.sample(range(len(found)), min(most, len(found))))
    return [found[k] for k in places]


def _package(mutant: Mutant) -> str:
    return Path(mutant.path).parts[2].removesuffix(".py")


def _trials(
    chosen: list[Mutant], options: argparse.Namespace, *, pure: bool
) -> Iterator[tuple[Mutant, Verdict]]:
    """Verdicts of the mutants of one build, in the order in which they come."""
    trees: SimpleQueue[Tree] = SimpleQueue()
    for k in range(options.workers):
        trees.put(Tree(WORK / f"tree-{k}"))
    folders = options.tests or folders_of(sorted({mutant.path for mutant in chosen}))
    print(f"{len(chosen)} mutants; measuring which tests run them: {' '.join(folders)}")
    first = trees.get()
    reach: Reach = measure(first, folders, pure=pure, workers=options.workers)
    trees.put(first)

    def trial(mutant: Mutant) -> tuple[Mutant, Verdict]:
        tests = reach.tests_of(mutant.path, mutant.line, options.within)
        tree = trees.get()
        try:
            return mutant, tree.run(
                mutant, tests, sum(reach.seconds.get(test, 0.0) for test in tests)
            )
        finally:
            trees.put(tree)

    with ThreadPoolExecutor(options.workers) as pool:
        yield from pool.map(trial, chosen)


def main() -> int:
    """Try the mutants; 1 when more survive than are let pass."""
    options = _arguments()
    chosen = _chosen(options)
    if not chosen:
        print("nothing to break: no changed lines of src/openacr")
        return 0
    verdicts: list[tuple[Mutant, Verdict]] = []
    for pure in (False, True):
        some = [mutant for mutant in chosen if mutant.path.endswith("_cy.py") == pure]
        if some:
            console = Console(stderr=True)
            trials = _trials(some, options, pure=pure)
            for mutant, verdict in track(trials, "mutants", len(some), console=console):
                verdicts.append((mutant, verdict))
                if verdict in LOST:
                    print(f"{verdict}: {mutant}", flush=True)
    if options.json:
        rows = [{"mutant": str(mutant), "verdict": verdict} for mutant, verdict in verdicts]
        options.json.write_text(json.dumps(rows, indent=1) + "\n")
    return _summary(verdicts, options.percent)


def _summary(verdicts: list[tuple[Mutant, Verdict]], percent: float) -> int:
    """Survivors of each package; 1 when one has more than its share."""
    package = {mutant: _package(mutant) for mutant, _ in verdicts}
    tried = Counter(package.values())
    lost = Counter(package[mutant] for mutant, verdict in verdicts if verdict in LOST)
    too_many = False
    for name in sorted(tried):
        share = 100.0 * lost[name] / tried[name]
        too_many |= share > percent
        print(f"{name}: {tried[name]} mutants, {lost[name]} survived ({share:.0f} %)")
    return int(too_many)


if __name__ == "__main__":
    raise SystemExit(main())
