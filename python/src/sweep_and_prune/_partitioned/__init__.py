"""The join of more boxes than fit in memory: space is split into cells, and each cell is one call of the finder.

```text
files -> cells -> search -> dataset, boxes -> spill -> plan -> folder -> tasks -> run, graph -> sweep_and_prune.dask
```

A module imports only earlier ones.
"""
