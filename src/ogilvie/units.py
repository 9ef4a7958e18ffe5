"""Units as plain floats: ``180 * deg``, ``18 * knot``. Everything inside the package is SI and radians.

Examples
--------
>>> from ogilvie.units import deg, knot
>>> round(18 * knot, 4)
9.26
>>> round(180 * deg, 6)
3.141593
"""

from math import pi

deg = pi / 180.0  #: rad
knot = 1852.0 / 3600.0  #: m/s
minute = 60.0  #: s
hour = 3600.0  #: s
tonne = 1000.0  #: kg

GRAVITY = 9.80665  #: m/s2, standard acceleration of gravity
SEA_WATER = 1025.0  #: kg/m3, density of sea water
