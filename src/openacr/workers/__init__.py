"""Calls done by many processes, on this computer or a Dask cluster; a process may die."""

from openacr.workers.calls import Call, Done, Lost, Pool
from openacr.workers.cluster import ClusterPool
from openacr.workers.local import LocalPool

__all__ = ["Call", "ClusterPool", "Done", "LocalPool", "Lost", "Pool"]
