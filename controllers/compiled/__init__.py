"""Compiling hot loops with numba, and keeping what was compiled.

Numba's own cache goes by the times and paths of files, and by a function's own file alone: a copy would compile all
anew, and a change in a kernel that another file calls would go unseen. Here kernels lie in a folder of the
user's that is named after the contents of all of our sources, so that a checkout, an installation and the tests share
them; each in a file with a checksum, so that what is damaged or half written is as good as not there. Where sources
were changed, a kernel is taken over from another version's folder if all that it is made of is the same
(`ingredients`): who edits a line, or brings Gambol up to date, waits for no more than what it changes.
"""

from .cache_places import DAY, cache_folder, cache_home, cold, forgets
from .numba_cache import kernel

__all__ = ["DAY", "cache_folder", "cache_home", "cold", "forgets", "kernel"]
