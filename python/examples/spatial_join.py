"""A spatial join of two tables: which photographs show which parcels of land?

Both tables have a rectangle in each row. The join is the table of all (photograph, parcel) whose rectangles touch.
"""

import numpy as np

import sweep_and_prune as sap

random = np.random.default_rng(2026)

# Parcels: a town of streets, each parcel 18 by 28 metres.
x, y = np.meshgrid(np.arange(0, 4000, 20.0), np.arange(0, 3000, 30.0))
corners = np.stack([x.ravel(), y.ravel()], axis=1)
parcels = np.hstack([corners, corners + [18, 28]])
owners = random.integers(0, 500, len(parcels))

# Photographs from the air: 2,000 of them, each 60 to 200 metres wide.
centres = random.uniform([0, 0], [4000, 3000], (2000, 2))
halves = random.uniform(30, 100, (2000, 1))
photographs = np.hstack([centres - halves, centres + halves])

join = sap.find_pairs_between(photographs, parcels)
photograph, parcel = join.T
print(f"{len(parcels)} parcels, {len(photographs)} photographs: {len(join)} rows in the join")

# What one does with a join: how many parcels on each photograph, and who has to be asked about most of them.
on_each = np.bincount(photograph, minlength=len(photographs))
asked = np.bincount(owners[parcel], minlength=500)
print(f"{on_each.mean():.1f} parcels on a photograph, {on_each.max()} at most")
print(f"owner {asked.argmax()} is on {asked.max()} of {asked.sum()} views")
