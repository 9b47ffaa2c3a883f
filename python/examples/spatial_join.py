"""A spatial join of two tables: which photographs show which parcels of land?

Both tables have one rectangle in each row. The join has a row for each photograph and parcel that overlap.
"""

import numpy as np

import sweep_and_prune as sap

random = np.random.default_rng(2026)

# Parcels: a town with streets, each parcel 18 by 28 meters.
x, y = np.meshgrid(np.arange(0, 4000, 20.0), np.arange(0, 3000, 30.0))
corners = np.stack([x.ravel(), y.ravel()], axis=1)
parcels = np.hstack([corners, corners + [18, 28]])
owners = random.integers(0, 500, len(parcels))

# Photographs from the air: 2,000 of them, each 60 to 200 meters wide.
centers = random.uniform([0, 0], [4000, 3000], (2000, 2))
halves = random.uniform(30, 100, (2000, 1))
photographs = np.hstack([centers - halves, centers + halves])

join = sap.find_pairs_between(photographs, parcels)
photograph, parcel = join.T
print(f"{len(parcels)} parcels, {len(photographs)} photographs: {len(join)} rows in the join")

# Use the join: how many parcels does each photograph show, and which owner is on most photographs?
on_each = np.bincount(photograph, minlength=len(photographs))
asked = np.bincount(owners[parcel], minlength=500)
print(f"{on_each.mean():.1f} parcels on a photograph, {on_each.max()} at most")
print(f"owner {asked.argmax()} is on {asked.max()} of {asked.sum()} views")
