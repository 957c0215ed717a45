"""Numba kernels over raw arrays; nothing here knows of drawings, windows or threads of ours."""
