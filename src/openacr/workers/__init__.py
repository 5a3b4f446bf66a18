"""Calls done by many processes, on this computer or a Dask cluster, or by one beside a server.

A process may die.
"""

from openacr.workers.background import Background
from openacr.workers.calls import Call, Done, Lost, Pool
from openacr.workers.cluster import ClusterPool
from openacr.workers.local import LocalPool

__all__ = ["Background", "Call", "ClusterPool", "Done", "LocalPool", "Lost", "Pool"]
