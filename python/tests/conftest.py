"""Settings of the property tests: no deadline, because the machine may be loaded, and no files left behind."""

from hypothesis import settings

settings.register_profile("project", deadline=None, database=None, print_blob=True)
settings.load_profile("project")
