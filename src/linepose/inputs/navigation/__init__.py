"""Navigation logs as devices write them: one format a file, with its settings and its reader, chosen by its name.

`read_navigation(source.navigation, folder)` reads any of them; to add one, see docs/formats.md. Names are imported when
they are first used: configuration needs the settings of one format only.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
