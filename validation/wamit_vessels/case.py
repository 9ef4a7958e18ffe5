"""A tanker and an FPSO: panel method against WAMIT 6.3."""

from typing import Any

import numpy as np

import ogilvie as og
from ogilvie.mesh.lid import waterplane_lid

TITLE = "Tanker and FPSO against WAMIT"
ABOUT = """Results of WAMIT 6.314 from the Marine Systems Simulator (T. I. Fossen and T. Perez, github.com/cybergalactic/MSS,
MIT licence): a tanker of 246 m, 4750 flat panels with irregular frequencies removed, and an FPSO of 200 m by the higher-order
method without that; its first irregular frequency is that of a box, 1.0 rad/s, and it is compared up to 0.73 rad/s. The tanker
is solved on WAMIT's own panels. For the FPSO the file's flat panels are halved twice along the sharp edges of its boxy hull,
where flat panels of constant potential converge slowly: at a period of 12.6 s roll damping is 3.4 % off without, 1.0 % with two
halvings, and 0.2 % when all panels are halved in both directions. Errors are parts of each curve's largest value; a coupling
below a tenth of the root of its two diagonal terms is measured against that tenth, and the note gives the part of its own
largest value (heave-pitch added mass of the FPSO, 1.3 % of the root, is 9 % off and does not come nearer with finer panels). To
the tolerance of 2 % is added by how far WAMIT's own ij and ji are off their mean."""
NEEDS = ["data/mss_wamit_tanker/tanker.1", "data/mss_wamit_fpso/fpso.1"]
HEIGHT = 8.0

DOFS = ("surge", "sway", "heave", "roll", "pitch", "yaw")
COUPLINGS = ((0, 4), (1, 3), (1, 5), (2, 4), (3, 5), (0, 2))
PERIODS = {"tanker": (15.32, 12.64, 10.44, 8.63, 7.16, 5.95), "FPSO": (24.94, 20.51, 15.32, 12.64, 10.44, 8.63)}
BAND = (0.2, 1.2)  # rad/s, where the curves' largest values are taken
LID = 4.5  # m
SMALL = 0.1  # couplings below this part of the root of the two diagonal terms are measured against this part


def run(shared: Any) -> tuple[list[dict], dict]:
    """Return the checks and what the figure needs."""
    tanker = og.load_mesh(shared / "data/mss_wamit_tanker/tanker.gdf")
    fpso = og.load_mesh(shared / "data/mss_wamit_fpso/fpso_low.gdf")
    vessels = {
        "tanker": (tanker, shared / "data/mss_wamit_tanker/tanker.1"),
        "FPSO": (_halved_along_edges(_halved_along_edges(fpso)), shared / "data/mss_wamit_fpso/fpso.1"),
    }
    checks, data = [], {}
    for name, (hull, path) in vessels.items():
        wamit = og.read_hydro(path)
        w = wamit.omega.values
        pick = sorted(int(np.abs(w - 2.0 * np.pi / T).argmin()) for T in PERIODS[name])
        ours = og.solve_bem(
            hull.with_lid(waterplane_lid(hull, size=LID)),
            omega=w[pick],
            wave_direction=wamit.wave_direction.values,
            rho=wamit.attrs["rho"],
            g=wamit.attrs["g"],
            cache=False,
            progress=False,
        )
        checks += _matrices(name, ours, wamit, pick) + _limits(name, ours, wamit) + _forces(name, ours, wamit, pick)
        data[name] = (ours, wamit)
    return checks, data


def draw(data: dict, fig: Any) -> None:
    """Diagonal damping of both vessels: WAMIT's lines, our points."""
    axes = fig.subplots(6, 2, sharex=True)
    for column, (name, (ours, wamit)) in zip(axes.T, data.items(), strict=True):
        column[0].set_title(name)
        column[-1].set_xlabel("omega, rad/s")
        for i, (axis, dof) in enumerate(zip(column, DOFS, strict=True)):
            near = wamit.omega < 1.2
            for variable, colour in (("added_mass", "C0"), ("radiation_damping", "C1")):
                scale = np.abs(wamit[variable].values[near, i, i]).max()
                axis.plot(wamit.omega[near], wamit[variable][near, i, i] / scale, color=colour, lw=1)
                axis.plot(ours.omega, ours[variable][:, i, i] / scale, ".", color=colour)
            axis.set_ylabel(dof)


def _matrices(name: str, ours: Any, wamit: Any, pick: list[int]) -> list[dict]:
    checks = []
    w = wamit.omega.values
    band = (w > BAND[0]) & (w < BAND[1])
    for letter, variable in (("A", "added_mass"), ("B", "radiation_damping")):
        found, wanted = ours[variable].values, wamit[variable].values
        size = np.sqrt(np.abs(np.einsum("wii->wi", wanted[band])).max(axis=0))
        for i, j in (*((i, i) for i in range(6)), *COUPLINGS):
            own = np.abs(wanted[band, i, j]).max()
            scale = max(own, SMALL * size[i] * size[j])
            error = np.abs(found[:, i, j] - wanted[pick, i, j])
            doubt = 0.5 * np.abs(wanted[pick, i, j] - wanted[pick, j, i])[error.argmax()] / scale  # theirs: zero on diagonals
            note = f"at {w[pick][error.argmax()]:.3g} rad/s"
            if doubt > 0.002:
                note += f"; WAMIT's own {i + 1}{j + 1} and {j + 1}{i + 1} are {100.0 * doubt:.1f} % off their mean"
            if scale > own:
                note += f"; small coupling: {100.0 * error.max() / own:.2g} % of its own largest value"
            checks.append(_check(f"{name}: {letter}{i + 1}{j + 1}", 100.0 * error.max() / scale, note, doubt=100.0 * doubt))
    return checks


def _limits(name: str, ours: Any, wamit: Any) -> list[dict]:
    checks = []
    for variable, where in (("added_mass_zero", "zero"), ("added_mass_inf", "infinite")):
        error = 100.0 * np.abs(np.diag(ours[variable].values) / np.diag(wamit[variable].values) - 1.0)
        checks.append(
            _check(f"{name}: A at {where} frequency", error.max(), f"largest of the six diagonal terms, {DOFS[error.argmax()]}")
        )
    return checks


def _forces(name: str, ours: Any, wamit: Any, pick: list[int]) -> list[dict]:
    w = wamit.omega.values
    wanted = wamit.excitation_force.values
    scale = np.abs(wanted[(w > BAND[0]) & (w < BAND[1])]).max(axis=(0, 1))
    error = 100.0 * np.abs(ours.excitation_force.values - wanted[pick]).max(axis=(0, 1)) / scale
    n = wanted.shape[1]
    return [_check(f"{name}: X{i + 1}", error[i], f"modulus and phase, {n} directions") for i in range(6)]


def _check(name: str, error: float, note: str, *, doubt: float = 0.0) -> dict:
    return {
        "name": name,
        "value": float(error),
        "reference": 0.0,
        "tolerance": 2.0 + float(doubt),
        "unit": "% of the largest value",
        "source": "WAMIT 6.314",
        "note": note,
    }


def _halved_along_edges(mesh: Any, angle: float = 30.0) -> Any:
    """Return the mesh with the quadrilaterals at sharp edges cut in two, parallel to the edge."""
    sides = _sharp_sides(mesh, np.cos(np.radians(angle)))
    panels = []
    for face, corner in enumerate(mesh.vertices[mesh.faces]):
        if face not in sides or mesh.is_triangle[face]:
            panels.append(corner)
            continue
        a, b, c, d = np.roll(corner, -sides[face], axis=0)
        panels += [np.array([a, b, 0.5 * (b + c), 0.5 * (a + d)]), np.array([0.5 * (a + d), 0.5 * (b + c), c, d])]
    points = np.concatenate(panels)
    faces = np.arange(len(points)).reshape(-1, 4)
    repeats = np.isclose(np.linalg.norm(points[faces[:, 2]] - points[faces[:, 3]], axis=1), 0.0)
    faces[repeats, 3] = faces[repeats, 2]
    return og.PanelMesh(points, faces, symmetry=mesh.symmetry, name=mesh.name)


def _sharp_sides(mesh: Any, cosine: float) -> dict[int, int]:
    """Return panels and their side that lies on an edge between patches at an angle, off the planes y = 0 and z = 0."""
    _, index = np.unique(np.round(mesh.vertices, 4), axis=0, return_inverse=True)
    users: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for face, corners in enumerate(index.ravel()[mesh.faces]):
        for i in range(4):
            a, b = sorted((int(corners[i]), int(corners[(i + 1) % 4])))
            if a != b:
                users.setdefault((a, b), []).append((face, i))
    found = {}
    for pairs in users.values():
        if len(pairs) == 2 and mesh.normals[pairs[0][0]] @ mesh.normals[pairs[1][0]] > cosine:
            continue
        for face, i in pairs:
            ends = mesh.vertices[mesh.faces[face, [i, (i + 1) % 4]]]
            if not any(np.allclose(ends[:, axis], 0.0, atol=1e-4) for axis in (1, 2)):
                found[face] = i
    return found
