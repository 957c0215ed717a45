"""Dots of hidden areas have no size: their share of the union was no number."""

import numpy as np

from stippler.kernels.tone.union_share import shares_of_union


def test_dots_without_size_have_whole_shares_and_take_nothing_from_others():
    rng = np.random.default_rng(5)
    discs = np.column_stack([rng.random((400, 2)) * 10, np.full(400, 0.4)]).astype(np.float32)
    alone = shares_of_union(discs)
    hidden = np.concatenate([discs, discs[:150] * (1, 1, 0)]).astype(np.float32)
    shares = shares_of_union(hidden)
    assert np.isfinite(shares).all()
    assert np.all(shares[400:] == 1.0)
    assert np.array_equal(shares[:400], alone)
