"""Filling shapes into rows of bits, without GL."""
