"""Readers and writers of meshes: real files, layouts, units, and damage of every kind."""

import struct

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from ogilvie.errors import FormatError, InputError, OgilvieError
from ogilvie.mesh.files import load_mesh, write_mesh
from ogilvie.mesh.gdf import read_gdf_header
from ogilvie.mesh.inspect import check_mesh, heal
from ogilvie.mesh.panels import PanelMesh

# file, volume that its SOURCE.md states (m3), stored panels of hull and lid, symmetry
REAL = [
    ("mss_wamit_tanker/tanker.gdf", 92314.0, 2375, 0, "xz"),
    ("mss_wamit_fpso/fpso_low.gdf", 97948.0, 1775, 0, "xz"),
    ("mss_wamit_semisub/semisub_low.gdf", 50600.0, 3425, 0, "xz+yz"),
    ("kvlcc2_hull/kvlcc2_coarse.gdf", 310848.0, 720, 0, "xz"),
    ("kvlcc2_hull/kvlcc2_fine.gdf", 311438.0, 1900, 0, "xz"),
    ("dtmb5415_hull/dtmb5415_maorg.gdf", 8419.9, 1440, 0, "xz"),
    ("wecsim_cylinder/cyl.gdf", 0.24176, 1008, 336, "none"),
    ("wecsim_ellipsoid/ellipsoid.gdf", 76.2138, 2500, 2500, "none"),
    ("wecsim_sphere_drift/sphere.GDF", 2.07293, 100, 0, "xz+yz"),
    ("hams_certtest/Cylinder/Input/HullMesh.pnl", 1.565, 276, 0, "none"),
    ("hams_certtest/Moonpool/Input/HullMesh.pnl", 2.352, 1581, 0, "none"),
]


@pytest.mark.parametrize(
    ("file", "volume", "n_faces", "n_lid", "symmetry"), REAL, ids=[r[0].split("/")[-1] + r[0][:8] for r in REAL]
)
def test_real_mesh_has_its_stated_volume(shared_data, file, volume, n_faces, n_lid, symmetry):
    mesh = load_mesh(shared_data / file)
    assert mesh.volume == pytest.approx(volume, rel=1e-3)
    assert (mesh.n_faces, mesh.lid.n_faces if mesh.lid else 0, mesh.symmetry) == (n_faces, n_lid, symmetry)
    assert mesh.volumes.min() > 0  # anticlockwise seen from the fluid
    assert mesh.bounds[1, 2] <= 0.0
    assert check_mesh(mesh).ok
    assert all(mesh.vertices[:, 1 if plane == "xz" else 0].min() >= -1e-9 for plane in mesh.planes)
    back = mesh.flipped()
    assert not check_mesh(back).ok


@pytest.mark.parametrize("ship", ["mss_wamit_fpso/fpso.gdf", "mss_wamit_semisub/semisub.gdf"])
def test_higher_order_gdf_is_refused(shared_data, ship):
    with pytest.raises(FormatError, match=r"line 4: a low-order GDF .* IGDEF -1[01].*ILOWGDF"):
        load_mesh(shared_data / ship)


@pytest.mark.parametrize(("case", "n", "area"), [("Cylinder", 132, 3.129825), ("Moonpool", 351, 2.352329)])
def test_waterplane_mesh_becomes_the_lid_of_its_hull(shared_data, case, n, area):
    folder = shared_data / "hams_certtest" / case / "Input"
    lid = load_mesh(folder / "WaterplaneMesh.pnl")
    hull = load_mesh(folder / "HullMesh.pnl").with_lid(lid)
    assert lid.n_faces == n
    assert lid.wetted_area == pytest.approx(area, rel=1e-6)
    assert lid.wetted_area == pytest.approx(-hull.moments[0][2], rel=1e-9)
    assert check_mesh(hull).ok


def test_plot_file_of_a_buoy_is_readable_and_healed(shared_data):
    raw = load_mesh(shared_data / "fshd_buoya5" / "BuoyA5_pan.dat")
    assert (raw.n_faces, raw.lid.n_faces) == (288, 128)
    assert check_mesh(raw)["edges run twice in one direction"] == 72  # images in the planes are turned over
    buoy, report = heal(raw)
    assert report.after.ok
    assert buoy.volumes == pytest.approx([buoy.volume] * 3, rel=1e-9)
    assert -buoy.moments[0][2] == pytest.approx(buoy.lid.wetted_area, rel=0.02)  # hull and lid divide the circle differently
    assert buoy.volume > 0


# ---- GDF layouts

CORNERS = np.array(  # half of a barge 10 x 4 x 1.5 m, y >= 0
    [
        [[-5, 0, -1.5], [-5, 2, -1.5], [5, 2, -1.5], [5, 0, -1.5]],
        [[-5, 2, -1.5], [-5, 2, 0], [5, 2, 0], [5, 2, -1.5]],
        [[5, 0, -1.5], [5, 2, -1.5], [5, 2, 0], [5, 0, 0]],
        [[-5, 0, -1.5], [-5, 0, 0], [-5, 2, 0], [-5, 2, -1.5]],
    ],
    dtype=float,
)
VOLUME = 60.0


def _gdf(body, *, head="1.0 9.80665 ULEN GRAV", flags="0 1 ISX ISY", count="4"):
    return "\n".join(["barge", head, flags, count, *body]) + "\n"


def _lines(corners=CORNERS, *, form="{:.5f} {:.5f} {:.5f}"):
    return [form.format(*p) for p in corners.reshape(-1, 3)]


def _load(folder, text, name="barge.gdf", **options):
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return load_mesh(path, **options)


NUMBERS = CORNERS.ravel()
LAYOUTS = {
    "three columns": _gdf(_lines()),
    "index columns": _gdf([f"{line}  {i}  7" for i, line in enumerate(_lines())]),
    "twelve columns": _gdf([" ".join(map(str, p)) for p in NUMBERS.reshape(-1, 12)]),
    "wrapped": _gdf([" ".join(map(str, NUMBERS[i : i + 5])) for i in range(0, len(NUMBERS), 5)]),
    "comments": _gdf([f"{line} ! corner" for line in _lines()], flags="0  1 \tISX ISY", count="4   NPAN"),
    "commas": _gdf(_lines(form="{}, {}, {}")),
    "Fortran D": _gdf(_lines(form="{:.5E} {:.5E} {:.5E}")).replace("E+", "D+").replace("E-", "d-"),
    "repeat counts": _gdf(_lines()).replace("-5.00000 0.00000 0.00000", "-5.0 2*0.0"),
    "blank lines": _gdf(_lines()).replace("\n", "\r\n\r\n", 1000).replace("\r\n\r\n", "\r\n", 4),
    "no last newline": _gdf(_lines()).rstrip(),
    "words after the data": _gdf(_lines()) + "end of file\n",
    "flat patches of order 0": _gdf(_lines(), count="4 0 NPATCH IGDEF"),
    "other side stored": _gdf(_lines(CORNERS[:, ::-1] * [1, -1, 1])),
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_gdf_layouts(tmp_path, layout):
    mesh = _load(tmp_path, LAYOUTS[layout])
    assert mesh.volumes == pytest.approx([VOLUME] * 3, rel=1e-9)
    assert (mesh.symmetry, mesh.n_faces, len(mesh.vertices), mesh.name) == ("xz", 4, 8, "barge")
    assert mesh.vertices[:, 1].min() == 0.0


@pytest.mark.parametrize(
    ("flags", "symmetry", "volume", "panels"),
    [("0 0", "none", VOLUME / 2, 4), ("1 0", "none", VOLUME, 8), ("1 1", "xz+yz", 2 * VOLUME, 4)],
)
def test_gdf_symmetry_flags(tmp_path, flags, symmetry, volume, panels):
    corners = CORNERS if flags == "0 0" else CORNERS + [5.0, 0.0, 0.0]  # a quarter, or the half x >= 0 of something longer
    if flags == "1 0":
        corners = np.delete(corners, 3, axis=0)
        mesh = _load(tmp_path, _gdf(_lines(corners), flags=flags, count="3"))
        panels = 6
    else:
        mesh = _load(tmp_path, _gdf(_lines(corners), flags=flags))
    assert (mesh.symmetry, mesh.n_faces) == (symmetry, panels)
    assert mesh.volume == pytest.approx(volume)


def test_gdf_units(tmp_path):
    feet = _load(tmp_path, _gdf(_lines(), head="1.0 32.174 ULEN GRAV"))
    assert feet.volume == pytest.approx(VOLUME * 0.3048**3)
    scaled = _load(tmp_path, _gdf(_lines(), head="246.0 9.81 ULEN GRAV"))
    assert scaled.volume == pytest.approx(VOLUME)  # ULEN does not scale the coordinates
    other = _gdf(_lines(), head="1.0 1.0 ULEN GRAV")
    with pytest.raises(FormatError, match=r"line 2: GRAV 9.8 .*unit="):
        _load(tmp_path, other)
    assert _load(tmp_path, other, unit=0.5).volume == pytest.approx(VOLUME / 8)
    assert read_gdf_header(tmp_path / "barge.gdf").ulen == 1.0


def test_degenerate_corners_become_triangles(tmp_path):
    corners = np.array([[[0.0, 0, -1], [1, 0, -1], [1, 1, -1], [1, 1, -1]], [[0, 0, -1], [0, 0, -1], [0, 1, -1], [1, 1, -1]]])
    mesh = _load(tmp_path, _gdf(_lines(corners), flags="0 0", count="2"))
    assert mesh.is_triangle.all()
    assert (mesh.faces[:, 2] == mesh.faces[:, 3]).all()
    assert len(mesh.vertices) == 4


def test_interior_panels_become_the_lid(tmp_path):
    lid = np.array([[[-5.0, 0, 0], [5, 0, 0], [5, 2, 0], [-5, 2, 0]]])
    mesh = _load(tmp_path, _gdf(_lines(np.concatenate([lid, CORNERS])), count="5"))
    assert (mesh.n_faces, mesh.lid.n_faces, mesh.lid.symmetry) == (4, 1, "xz")
    assert mesh.volume == pytest.approx(VOLUME)
    deeper = _load(tmp_path, _gdf(_lines(np.concatenate([lid, CORNERS])), count="5"), offset=(0.0, 0.0, -1.0, 0.0))
    assert (deeper.n_faces, deeper.lid) == (5, None)  # a deck under water is hull


def test_offset_is_xbody(tmp_path):
    mesh = _load(tmp_path, _gdf(_lines()), offset=(100.0, 20.0, 0.0, np.pi / 2))
    assert mesh.symmetry == "none"
    assert mesh.bounds == pytest.approx(np.array([[98.0, 15.0, -1.5], [102.0, 25.0, 0.0]]))
    assert _load(tmp_path, _gdf(_lines()), offset=(3.0, 0.0, 0.0, 0.0)).symmetry == "xz"


# ---- other formats

PNL = """\
    --------------Hull Mesh File---------------

    # Number of Panels, Nodes, X-Symmetry and Y-Symmetry
         {panels}         {nodes}           0           1

    #Start Definition of Node Coordinates     ! node_number   x   y   z
{node_lines}
   #End Definition of Node Coordinates

   #Start Definition of Node Relations   ! panel_number number_of_vertices   Vertex1_ID ...
{panel_lines}
   #End Definition of Node Relations

    --------------End Hull Mesh File---------------
"""


def _nodes_and_panels():
    nodes, index = np.unique(CORNERS.reshape(-1, 3), axis=0, return_inverse=True)
    return nodes, index.reshape(-1, 4) + 1


def _pnl():
    nodes, panels = _nodes_and_panels()
    return PNL.format(
        panels=len(panels),
        nodes=len(nodes),
        node_lines="\n".join(f"{i:5d} {x:16.6f} {y:16.6f} {z:16.6f}" for i, (x, y, z) in enumerate(nodes, start=1)),
        panel_lines="\n".join(f"{i:5d} 4 " + " ".join(map(str, p)) for i, p in enumerate(panels, start=1)),
    )


def _nemoh():
    nodes, panels = _nodes_and_panels()
    lines = ["    2    1", *(f"{i} {x:.3f} {y:.3f} {z:.3f}" for i, (x, y, z) in enumerate(nodes, start=1)), "0 0. 0. 0."]
    return "\n".join([*lines, *(" ".join(map(str, p)) for p in panels), "0 0 0 0"]) + "\n"


def _tecplot():
    blocks = []
    for p in CORNERS[:, [0, 1, 3, 2]]:
        blocks.append("zone I=     2   J=     2  F=POINT\n" + "\n".join(f"{x:12.3f}{y:12.3f}{z:12.3f}" for x, y, z in p))
    return "\n".join(blocks) + "\n"


def _stl_text():
    facets = []
    for p in CORNERS:
        for a, b, c in ((p[0], p[1], p[2]), (p[0], p[2], p[3])):
            corners = "\n".join(f"    vertex {x:.4e} {y:.4e} {z:.4e}" for x, y, z in (a, b, c))
            facets.append(f"facet normal 0 0 1\n  outer loop\n{corners}\n  endloop\nendfacet")
    return "\n".join(["solid barge", *facets, "endsolid barge"]) + "\n"


def _stl_binary():
    data = b"barge".ljust(80) + struct.pack("<I", 8)
    for p in CORNERS:
        for triangle in ((p[0], p[1], p[2]), (p[0], p[2], p[3])):
            data += struct.pack("<12fH", 0, 0, 1, *np.ravel(triangle), 0)
    return data


def _obj():
    nodes, panels = _nodes_and_panels()
    lines = ["# barge", "o hull", *(f"v {x} {y} {z}" for x, y, z in nodes), "s off"]
    return "\n".join([*lines, *("f " + " ".join(f"{i}//1" for i in p) for p in panels)]) + "\n"


def _msh():
    nodes, panels = _nodes_and_panels()
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$Nodes", str(len(nodes))]
    lines += [f"{i} {x} {y} {z}" for i, (x, y, z) in enumerate(nodes, start=1)]
    lines += ["$EndNodes", "$Elements", str(len(panels) + 1), "1 1 2 0 1 1 2"]
    lines += [f"{i} 3 2 0 1 " + " ".join(map(str, p)) for i, p in enumerate(panels, start=2)]
    return "\n".join([*lines, "$EndElements"]) + "\n"


FILES = {
    "barge.gdf": LAYOUTS["three columns"],
    "barge.pnl": _pnl(),
    "barge.dat": _nemoh(),
    "barge_pan.dat": _tecplot(),
    "barge.stl": _stl_text(),
    "barge_binary.STL": _stl_binary(),
    "barge.obj": _obj(),
    "barge.msh": _msh(),
}
SAYS_SYMMETRY = {"barge.gdf", "barge.pnl", "barge.dat"}


def _options(name):
    return {} if name in SAYS_SYMMETRY else {"symmetry": "xz"}


@pytest.mark.parametrize("name", FILES)
def test_every_format_gives_the_same_barge(tmp_path, name):
    mesh = _load(tmp_path, FILES[name], name, **_options(name))
    assert mesh.volumes == pytest.approx([VOLUME] * 3, rel=1e-6)
    assert (mesh.symmetry, len(mesh.vertices)) == ("xz", 8)
    assert mesh.n_faces == (8 if "stl" in name.lower() else 4)
    assert check_mesh(mesh).ok


@pytest.mark.parametrize("name", sorted(set(FILES) - SAYS_SYMMETRY))
def test_symmetry_and_unit_can_be_given(tmp_path, name):
    half = _load(tmp_path, FILES[name], name)
    assert (half.symmetry, half.volume) == ("none", pytest.approx(VOLUME / 2, rel=1e-6))
    assert _load(tmp_path, FILES[name], name, unit=1e-3).length == pytest.approx(0.01)


@pytest.mark.parametrize("binary", [True, False])
@pytest.mark.parametrize("version", ["gmsh22", "gmsh"])
def test_msh_versions(tmp_path, version, binary):
    import meshio

    nodes, panels = _nodes_and_panels()
    path = tmp_path / "hull.msh"
    meshio.write(path, meshio.Mesh(nodes, [("quad", panels - 1)]), file_format=version, binary=binary)
    assert load_mesh(path, symmetry="xz").volume == pytest.approx(VOLUME)


# ---- writing


@pytest.mark.parametrize("symmetry", ["none", "xz", "xz+yz"])
def test_gdf_written_and_read_again(tmp_path, box, symmetry):
    lid = box(low=-2.0, high=0.0, symmetry=symmetry, n=4).translated((0, 0, 0))
    deck = lid.vertices[lid.faces][:, :, 2].min(axis=1) == 0.0
    lid = PanelMesh(lid.vertices, lid.faces[deck], symmetry=symmetry)
    hull = box(np.pi, 2 * np.e, -1.0, 0.0, symmetry=symmetry, n=4, deck=False).with_lid(lid)
    write_mesh(hull, tmp_path / "a.gdf", ulen=12.5)
    again = load_mesh(tmp_path / "a.gdf")
    assert again.vertices[again.faces] == pytest.approx(hull.vertices[hull.faces], abs=1e-9)
    assert (again.symmetry, again.lid.n_faces) == (symmetry, lid.n_faces)
    assert read_gdf_header(tmp_path / "a.gdf").ulen == 12.5
    write_mesh(hull, tmp_path / "b.gdf", lid=False)
    assert load_mesh(tmp_path / "b.gdf").lid is None
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.gdf", "b.gdf"]  # nothing half-written


def test_stl_written_and_read_again(tmp_path, box):
    hull = box(symmetry="xz", deck=False)
    write_mesh(hull, tmp_path / "a.stl")
    again = load_mesh(tmp_path / "a.stl")
    assert (again.symmetry, again.n_faces) == ("none", 4 * hull.n_faces)
    assert again.volume == pytest.approx(hull.volume, rel=1e-6)


def test_real_mesh_written_and_read_again(shared_data, tmp_path):
    mesh = load_mesh(shared_data / "wecsim_cylinder" / "cyl.gdf")
    write_mesh(mesh, tmp_path / "cyl.gdf")
    again = load_mesh(tmp_path / "cyl.gdf")
    assert again.vertices[again.faces] == pytest.approx(mesh.vertices[mesh.faces], abs=1e-12)
    assert again.lid.n_faces == 336


@pytest.mark.parametrize(
    ("name", "options"), [("a.xyz", {}), ("a.gdf", {"ulen": 0.0}), ("none/a.gdf", {}), ("a.gdf", {"format": "obj"})]
)
def test_what_cannot_be_written(tmp_path, box, name, options):
    with pytest.raises(InputError, match="expected"):
        write_mesh(box(), tmp_path / name, **options)
    assert list(tmp_path.iterdir()) == []


# ---- bad input

GDF_FAULTS = {
    "truncated": (
        "\n".join(FILES["barge.gdf"].split("\n")[:12]),
        r"barge.gdf line 12: 48 coordinates .* 24 in 8 lines found.*truncated",
    ),
    "too many": (FILES["barge.gdf"] + "1 2 3\n", r"line 21: 48 coordinates .* 51 in 17 lines.*line 4"),
    "letters": (FILES["barge.gdf"].replace("2.00000", "two", 1), r"line 6: numbers .* '-5.00000 two -1.50000' found"),
    "NaN": (FILES["barge.gdf"].replace("2.00000", "NaN", 1), "line 6"),
    "infinity": (FILES["barge.gdf"].replace("2.00000", "1e999", 1), "line 6"),
    "asterisks": (FILES["barge.gdf"].replace("2.00000", "********", 1), "line 6"),
    "ragged": (_gdf([f"{line} {i}" for i, line in enumerate(_lines())][:-1] + [_lines()[-1] + " 1 2"]), "line 20: 4 columns"),
    "no panels": (_gdf(_lines(), count="0"), "line 4: at least one panel"),
    "count in words": (_gdf(_lines(), count="many"), "line 4: the number of panels"),
    "walls": (_gdf(_lines(), flags="0 -1"), "line 3: ISX and ISY 0 or 1"),
    "flags missing": (_gdf(_lines(), flags="0"), "line 3: ISX ISY"),
    "negative ULEN": (_gdf(_lines(), head="-1 9.81"), "line 2: two positive"),
    "both sides of a symmetry": (_gdf(_lines(CORNERS - [0, 1, 0])), r"one side of the plane of symmetry y = 0"),
    "header alone": ("barge\n1 9.81\n0 1\n4\n", "line 4: 48 coordinates"),
    "two lines": ("barge\n1 9.81\n", "line 3: ISX ISY expected, the end of the file"),
    "empty": ("", "an empty file"),
    "binary": (b"\x00\x01\x02" * 50, "binary data"),
}


@pytest.mark.parametrize("fault", GDF_FAULTS)
def test_faults_of_gdf_are_named(tmp_path, fault):
    text, message = GDF_FAULTS[fault]
    with pytest.raises(FormatError, match=message):
        _load(tmp_path, text)


FAULTS = [
    ("barge.pnl", lambda t: t[: t.index("#End Definition of Node Relations")], "End Definition of Node Relations"),
    ("barge.pnl", lambda t: t.replace("    4 4 ", "    9 4 "), "panel 4 with 3 or 4 corners"),
    ("barge.pnl", lambda t: t.replace("\n    8  ", "\n    9  ", 1), "node 8 with x y z"),
    ("barge.pnl", lambda t: t.replace("   1 4 ", "   1 5 ", 1), "panel 1 with 3 or 4 corners"),
    ("barge.pnl", lambda t: t.replace("1 4 1", "1 4 99", 1), r"node numbers 1\.\.8"),
    ("barge.pnl", lambda t: "\n".join(t.split("\n")[:11]), "8 nodes and 4 panels .12 lines"),
    ("barge.dat", lambda t: t.replace("2    1", "3    1"), "'2 0' or '2 1'"),
    ("barge.dat", lambda t: t.replace("0 0 0 0", ""), "four node numbers"),
    ("barge.dat", lambda t: t.replace("0 0. 0. 0.\n", ""), "line 10"),
    ("barge.dat", lambda t: t.replace("\n4 ", "\n7 ", 1), "node 4 with x y z"),
    ("barge_pan.dat", lambda t: t.replace("I=     2", "I=     3", 1), "line 1: a zone I=2, J=2"),
    ("barge_pan.dat", lambda t: t.replace("2.000", "", 1), "three numbers x y z"),
    ("barge.stl", lambda t: t.replace("endsolid", ""), "STL keyword"),
    ("barge.stl", lambda t: t.replace("vertex -5.0000e+00", "vertex", 1), "line 4: vertex x y z"),
    ("barge.stl", lambda t: t[:695], "line 26: 'facet', three 'vertex'"),
    ("barge_binary.STL", lambda t: t[:-10], "neither"),
    ("barge_binary.STL", lambda t: t[:96] + struct.pack("<f", float("nan")) + t[100:], "finite coordinates"),
    ("barge.obj", lambda t: t.replace("v -5.0", "v", 1), "line 3: v x y z"),
    ("barge.obj", lambda t: t.replace("v -5.0", "w -5.0", 1), "line 3: an OBJ keyword"),
    ("barge.obj", lambda t: t + "f 1 2 3 4 5\n", "5 corners"),
    ("barge.obj", lambda t: t + "f 1 2 77\n", r"points 1\.\.8 expected"),
    ("barge.msh", lambda t: t.replace("$EndElements", ""), r"\$Elements .. \$EndElements not found"),
    ("barge.msh", lambda t: t.replace("2.2 0 8", "9.9 0 8"), "readable .msh"),
    ("barge.msh", lambda t: t.replace("2 3 2 0 1", "2 5 2 0 1 1 2 3 4", 1), "readable .msh|hexahedron"),
]


@pytest.mark.parametrize(("name", "damage", "message"), FAULTS)
def test_faults_are_named(tmp_path, name, damage, message):
    with pytest.raises(FormatError, match=message) as caught:
        _load(tmp_path, damage(FILES[name]), name)
    assert str(caught.value).startswith(name)


@pytest.mark.parametrize(
    ("name", "options", "message"),
    [
        ("barge.gdf", {"symmetry": "xz"}, "say their symmetry themselves"),
        ("barge.stl", {"symmetry": "yz"}, "'xz' or 'xz"),
        ("barge.gdf", {"unit": -1.0}, "unit"),
        ("barge.gdf", {"format": "wamit"}, "one of gdf"),
        ("barge.gdf", {"offset": (1.0, 2.0)}, "offset"),
        ("barge.hull", {}, "an ending of"),
    ],
)
def test_bad_arguments(tmp_path, name, options, message):
    with pytest.raises(InputError, match=message):
        _load(tmp_path, FILES.get(name, ""), name, **options)


def test_missing_file_and_folder(tmp_path):
    for path in (tmp_path / "no.gdf", tmp_path / "no.stl", tmp_path / "no.msh", tmp_path / "no.dat"):
        with pytest.raises(InputError, match="No such file"):
            load_mesh(path)
    with pytest.raises(InputError, match="readable file"):
        load_mesh(tmp_path, format="gdf")


# ---- damage by chance: reads right, or says what is wrong


def _damaged(data: bytes, kind: str, place: float, token: bytes) -> bytes:
    i = int(place * len(data))
    if kind == "truncated":
        return data[:i]
    if kind == "inserted":
        return data[:i] + token + data[i:]
    if kind == "overwritten":
        return data[:i] + token + data[i + len(token) :]
    if kind == "hole":
        return data[:i] + data[i + 37 :]
    words = data.split(b" ")
    words[int(place * len(words))] = token
    return b" ".join(words)


TOKENS = st.sampled_from(
    [b"NaN", b"inf", b"-Infinity", b"abc", b"1e400", b"***", b"\x00\xff", b"\n", b",,", b"-", b"99999999999", b"1.5.2"]
)
KINDS = st.sampled_from(["truncated", "inserted", "overwritten", "hole", "word"])


@pytest.mark.parametrize("name", FILES)
@given(kind=KINDS, place=st.floats(0.0, 0.999), token=TOKENS | st.binary(min_size=1, max_size=6))
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_damaged_files_read_right_or_are_refused(tmp_path, name, kind, place, token):
    data = FILES[name] if isinstance(FILES[name], bytes) else FILES[name].encode()
    try:
        mesh = _load(tmp_path, _damaged(data, kind, place, token), name, **_options(name))
    except FormatError as error:
        message = str(error)
        assert name in message
    else:
        assert np.isfinite(mesh.vertices).all()
        assert mesh.n_faces >= 1
        check_mesh(mesh)  # never fails


@pytest.mark.parametrize("name", ["barge.gdf", "barge.pnl", "barge.dat", "barge.stl", "barge_binary.STL", "barge.msh"])
@given(place=st.floats(0.0, 1.0))
@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_truncated_file_never_loses_panels(tmp_path, name, place):  # OBJ and plot files have no count and no end
    data = FILES[name] if isinstance(FILES[name], bytes) else FILES[name].encode()
    try:
        mesh = _load(tmp_path, data[: int(place * len(data))], name, **_options(name))
    except OgilvieError:
        return
    assert mesh.n_faces == (8 if "stl" in name.lower() else 4)
