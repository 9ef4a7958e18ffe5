"""The S175 container ship: published offsets as a table, and its hull."""

from ogilvie.mesh.loft import from_offsets
from ogilvie.mesh.panels import PanelMesh

LENGTH, BEAM, DRAUGHT = 175.0, 25.4, 9.5  #: m: between perpendiculars, moulded, design

#: Station (x from midship, positive forward, m): "half-breadth height, ..." (m, heights above the baseline), keel first.
_OFFSETS = (
    (
        87.5,
        "0 0.13, 0.54 0.25, 0.66 0.5, 0.91 0.75, 1.05 1, 1.34 2, 1.32 3, 1.1 4, "
        "0.82 5, 0.56 6, 0.35 7, 0.2 8, 0.1 9, 0.11 10, 0.28 11",
    ),
    (83.125, "0 0, 0.7 0.25, 1 0.5, 1.32 1, 1.57 2, 1.52 3, 1.36 4, 1.16 5, 0.95 6, 0.8 7, 0.7 8, 0.8 9, 0.96 10, 1.21 11"),
    (78.75, "0 0, 0.15 0, 1.13 0.5, 1.44 1, 1.77 2, 1.75 3, 1.45 5, 1.32 6, 1.27 7, 1.3 8, 1.4 9, 1.7 10, 2.07 11"),
    (
        70.0,
        "0 0, 0.13 0, 0.25 0.01, 1.42 0.5, 1.88 1, 2.29 2, 2.39 3, 2.4 4, "
        "2.39 5, 2.42 6, 2.52 7, 2.7 8, 2.87 9, 3.28 10, 3.87 11",
    ),
    (
        61.25,
        "0 0, 0.3 0.01, 0.59 0.02, 1.92 0.5, 2.43 1, 3.01 2, 3.34 3, 3.58 4, "
        "3.78 5, 3.99 6, 4.21 7, 4.48 8, 4.82 9, 5.24 10, 5.77 11",
    ),
    (
        52.5,
        "0 0, 0.67 0.02, 1.33 0.04, 2.79 0.5, 3.4 1, 4.1 2, 4.7 3, 5.11 4, 5.79 6, 6.1 7, 6.45 8, 6.81 9, 7.24 10, 7.71 11",
    ),
    (
        43.75,
        "0 0, 1.02 0.03, 2.03 0.06, 4 0.5, 4.75 1, 5.78 2, 6.33 3, 6.86 4, 7.28 5, 8.04 7, 8.38 8, 8.76 9, 9.11 10, 9.5 11",
    ),
    (
        35.0,
        "0 0, 1.97 0.05, 3.94 0.11, 5.32 0.5, 6.34 1, 7.42 2, 8.14 3, 8.67 4, "
        "9.1 5, 9.46 6, 9.8 7, 10.1 8, 10.38 9, 10.68 10, 10.93 11",
    ),
    (
        26.25,
        "0 0, 2.79 0.08, 5.58 0.15, 7.1 0.5, 8.02 1, 9.15 2, 9.88 3, 10.23 4, "
        "10.73 5, 11.01 6, 11.24 7, 11.44 8, 11.6 9, 11.78 10, 11.91 11",
    ),
    (
        17.5,
        "0 0, 7.32 0.2, 8.8 0.5, 9.66 1, 10.68 2, 11.31 3, 11.71 4, 11.98 5, 12.14 6, 12.26 7, 12.35 8, 12.45 10, 12.49 11",
    ),
    (
        8.75,
        "0 0, 4.48 0.12, 8.95 0.25, 10.1 0.5, 11.04 1, 11.86 2, 12.28 3, 12.5 4, "
        "12.6 5, 12.63 6, 12.65 7, 12.67 9, 12.69 10, 12.7 11",
    ),
    (0.0, "0 0, 4.95 0.14, 9.91 0.27, 10.96 0.5, 11.74 1, 12.44 2, 12.68 3, 12.7 4, 12.7 11"),
    (-8.75, "0 0, 4.72 0.13, 9.43 0.26, 10.86 0.5, 11.62 1, 12.25 2, 12.61 3, 12.69 4, 12.7 5, 12.7 11"),
    (
        -17.5,
        "0 0, 3.75 0.1, 7.5 0.21, 9.81 0.5, 10.66 1, 11.68 2, 12.09 3, 12.36 4, "
        "12.51 5, 12.6 6, 12.66 7, 12.69 8, 12.7 9, 12.7 11",
    ),
    (
        -26.25,
        "0 0, 2.91 0.08, 5.83 0.16, 7.99 0.5, 9.07 1, 10.14 2, 11.11 3, 11.63 4, "
        "11.98 5, 12.24 6, 12.4 7, 12.52 8, 12.63 9, 12.65 10, 12.68 11",
    ),
    (
        -35.0,
        "0 0, 1.67 0.05, 3.33 0.09, 5.93 0.5, 7.15 1, 8.64 2, 9.67 3, 10.28 4, "
        "10.96 5, 11.42 6, 11.75 7, 12.13 8, 12.43 10, 12.52 11",
    ),
    (
        -43.75,
        "0 0, 0.96 0.03, 1.91 0.05, 4.19 0.5, 5.3 1, 6.75 2, 7.79 3, 8.64 4, "
        "9.4 5, 10.14 6, 10.62 7, 11.09 8, 11.51 9, 11.85 10, 12.15 11",
    ),
    (
        -52.5,
        "0 0, 0.51 0.01, 1.03 0.03, 2.79 0.5, 3.73 1, 4.91 2, 5.88 3, 6.57 4, "
        "8.17 6, 8.9 7, 9.67 8, 10.35 9, 10.95 10, 11.45 11",
    ),
    (
        -61.25,
        "0 0, 0.27 0.01, 0.53 0.02, 1.77 0.5, 2.43 1, 3.27 2, 3.88 3, 4.45 4, "
        "5.08 5, 5.86 6, 6.79 7, 7.75 8, 8.67 9, 9.52 10, 10.27 11",
    ),
    (
        -70.0,
        "0 0, 0.15 0, 0.3 0.01, 0.97 0.5, 1.36 1, 1.85 2, 2.18 3, 2.5 4, "
        "2.88 5, 3.45 6, 4.3 7, 5.38 8, 6.48 9, 7.56 10, 8.58 11",
    ),
    (-78.75, "0 0, 0.32 0.5, 0.41 1, 0.55 2, 0.65 3, 0.73 4, 0.85 5, 1.04 6, 1.31 7, 2.2 8, 3.74 9, 5.18 10, 6.27 11"),
    (-83.125, "0 8.2, 1.05 8.5, 2.19 9, 3.07 9.5, 4.14 10.25, 4.95 11"),
    (-87.5, "0 8.72, 0.26 8.86, 0.65 9, 1.08 9.25, 1.55 9.5, 2.55 10.25, 3.39 11"),
    (-89.1625, "0 9.02, 0.43 9.26, 0.85 9.5, 1.97 10.25, 2.83 11"),
)

#: Aft end of the skeg (x, m): the offsets leave the profile open between the last two full stations.
_STERN_POST = -83.125


def s175_offsets() -> list[tuple[float, list[tuple[float, float]]]]:
    """Return the published offsets of the S175 container ship, 24 stations from bow to stern.

    Returns
    -------
    list of (x, points)
        x from midship, positive forward, m; points are (half-breadth, height above the baseline), m, from keel to 1.5 m above
        the design water (9.5 m).

    Notes
    -----
    By trapezoids between the stations as given: 24,015 m3 to the design water, centre of buoyancy 2.547 m aft of midship.

    References
    ----------
    ITTC Seakeeping Committee, comparative study on the S-175 container ship, 15th and 17th ITTC (1978, 1983); offsets as
    distributed with the S175 ShipX data of the Marine Systems Simulator (MSS, Fossen and Perez).

    Examples
    --------
    >>> offsets = s175_offsets()
    >>> len(offsets), offsets[11][0], offsets[11][1][:4]
    (24, 0.0, [(0.0, 0.0), (4.95, 0.14), (9.91, 0.27), (10.96, 0.5)])
    """
    return [(x, [_pair(p) for p in row.split(",")]) for x, row in _OFFSETS]


def _pair(text: str) -> tuple[float, float]:
    y, z = text.split()
    return float(y), float(z)


def s175(*, panels: int = 1000, above_water: bool = False, name: str = "S175") -> PanelMesh:
    """Return the hull of the S175 container ship at its design draught of 9.5 m.

    Parameters
    ----------
    panels : int
        Largest number of panels of the whole hull below the water.
    above_water : bool
        Add the sides up to 1.5 m above the water, where the offsets end; these panels count extra.
    name : str

    Returns
    -------
    PanelMesh
        Symmetry "xz"; x from midship, z = 0 at the water.

    Notes
    -----
    :func:`s175_offsets` lofted by :func:`ogilvie.mesh.loft.from_offsets`. Two details that the table leaves open: the skeg
    ends in a post at x = -83.125 m, to which its waterlines run (those forward of it point to -82.5 m); the bow, whose first
    station is still 2.7 m wide at the bulb, is closed by a round nose of 1.3 m. The smooth surface holds 24,124 m3, 0.45 %
    more than trapezoids between the points of the table: curves through the points 0.25, between the stations 0.15, the nose
    0.05 %.

    Examples
    --------
    >>> hull = s175(panels=800)
    >>> hull.symmetry, round(hull.volume, -2), round(float(hull.center_of_buoyancy[0]), 1)
    ('xz', 24100.0, -2.5)
    """
    stations = [(x, [(0.0, 0.0), *p] if x == _STERN_POST else p) for x, p in s175_offsets()]
    return from_offsets(stations, draught=DRAUGHT, panels=panels, above_water=above_water, name=name)
