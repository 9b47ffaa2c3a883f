"""How the property tests run: a loaded machine is no failure, and nothing is left behind."""

from hypothesis import settings

settings.register_profile("ours", deadline=None, database=None, print_blob=True)
settings.load_profile("ours")
