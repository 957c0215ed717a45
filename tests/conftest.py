"""Settings shared by all tests.

``HYPOTHESIS_PROFILE=free`` takes other examples at each run and keeps those that fail;
``HYPOTHESIS_PROFILE=long`` takes ten times as many of them. ``--hypothesis-seed=N`` repeats a run.
"""

import os
import tempfile

from hypothesis import Phase, settings

settings.register_profile("repeatable", derandomize=True, deadline=None, print_blob=True)
settings.register_profile("free", deadline=None, print_blob=True)
settings.register_profile(
    "mutants", derandomize=True, deadline=None, phases=(Phase.explicit, Phase.generate)
)  # one failure is enough
settings.register_profile("long", deadline=None, print_blob=True, max_examples=1000)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "repeatable"))
os.environ["STIPPLER_STATE_DIR"] = tempfile.mkdtemp(prefix="stippler-state-")  # not a person's
os.environ.setdefault("LP_NUM_THREADS", "1")  # software GL's: two processes share two cores
EXAMPLES = 10 if os.environ.get("HYPOTHESIS_PROFILE") == "long" else 1
"""Tests that set their own number of examples take so many times as many."""
