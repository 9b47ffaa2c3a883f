"""Genomic intervals: how many reads lie on each gene, and which genes are near each other.

Intervals are half-open, as in BED files: one that ends at 100 does not touch one that begins there.
"""

import numpy as np

import sweep_and_prune as sap

random = np.random.default_rng(11)
names = np.array([f"chr{number}" for number in range(1, 23)])


def intervals(count: int, lengths: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    start = random.integers(0, 10_000_000, count)
    return names[random.integers(0, len(names), count)], np.stack([start, start + random.integers(*lengths, count)], 1)


gene_names, genes = intervals(5000, (1000, 50_000))
read_names, reads = intervals(200_000, (50, 150))

gene, read = sap.find_pairs_between(genes, reads, closed="left", by=(gene_names, read_names)).T
reads_of_gene = np.bincount(gene, minlength=len(genes))
print(f"{len(gene)} overlaps; {reads_of_gene.mean():.1f} reads on a gene, {reads_of_gene.max()} at most")
print(f"{len(reads) - len(np.unique(read))} reads lie on no gene")

# How many bases of each overlap are common to both?
common = np.minimum(genes[gene, 1], reads[read, 1]) - np.maximum(genes[gene, 0], reads[read, 0])
print(f"{(common == reads[read, 1] - reads[read, 0]).mean() * 100:.0f} % of the overlaps hold the whole read")

near = sap.count_pairs(genes, closed="left", by=gene_names, margin=1000)
print(f"{near} pairs of genes are less than 1,000 bases apart, or overlap")
