"""How kernels are compiled, kept, vectorised and spread over the cores."""
