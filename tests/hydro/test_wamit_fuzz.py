"""WAMIT's files under random content and random damage: read right, or FormatError / ConventionError, nothing else."""

import tempfile
from functools import cache
from pathlib import Path

import numpy as np
import xarray as xr
from hypothesis import example, given, settings
from hypothesis import strategies as st

from ogilvie.errors import ConventionError, FormatError
from ogilvie.hydro.files import read_hydro
from ogilvie.hydro.schema import DOFS, hydro_from_arrays
from ogilvie.hydro.wamit_write import write_wamit

TABLES = ("1", "3", "3fk", "3sc", "4", "8", "9", "hst")
RUN_FILES = ("out", "frc")


def body(omega, degrees, dofs=DOFS, *, seed: int = 0, size: float = 1.0, split: bool = False) -> xr.Dataset:
    """A data set of random numbers with every coupling of port-starboard symmetry."""
    rng = np.random.default_rng(seed)
    w, b, n = np.asarray(omega, dtype=float), np.deg2rad(degrees), len(dofs)
    index = np.array([DOFS.index(dof) for dof in dofs])
    alike = (index[:, None] - index[None, :]) % 2 == 0

    def matrix(*lead):
        return np.where(alike, size * 10.0 ** rng.uniform(-3, 6, (*lead, n, n)) * rng.choice([-1.0, 1.0], (*lead, n, n)), 0.0)

    F = size * 10.0 ** rng.uniform(-3, 6, (len(w), len(b), n)) * np.exp(2j * np.pi * rng.uniform(size=(len(w), len(b), n)))
    FK = 0.4 * F
    return hydro_from_arrays(
        omega=w,
        wave_direction=b,
        added_mass=matrix(len(w)),
        radiation_damping=matrix(len(w)),
        added_mass_inf=matrix(),
        added_mass_zero=matrix(),
        excitation_force=F,
        froude_krylov_force=FK if split else None,
        diffraction_force=F - FK if split else None,
        motion_rao=1e-6 * F,
        mean_drift=None,
        hydrostatic_stiffness=matrix(),
        inertia_matrix=matrix(),
        dofs=tuple(dofs),
    )


omegas = st.lists(st.integers(5, 3000), min_size=1, max_size=6, unique=True).map(lambda v: np.array(v) / 100.0)
headings = st.lists(st.integers(0, 359), min_size=1, max_size=4, unique=True)
some_dofs = st.sets(st.sampled_from(DOFS), min_size=1).map(lambda s: tuple(d for d in DOFS if d in s))


@settings(max_examples=40, deadline=None)
@given(omegas, headings, some_dofs, st.integers(0, 999), st.floats(0.01, 300.0), st.floats(1e-3, 1e4))
def test_any_data_set_survives_writing_to_the_printed_digits(omega, degrees, dofs, seed, ulen, size):
    hydro = body(omega, degrees, dofs, seed=seed, size=size)
    with tempfile.TemporaryDirectory() as folder:
        write_wamit(hydro, Path(folder) / "x", ulen=ulen)
        back = read_hydro(Path(folder) / "x", probe=False)
    assert back.influenced_dof.values.tolist() == list(dofs)
    np.testing.assert_allclose(back.omega, hydro.omega, rtol=6e-7)
    np.testing.assert_allclose(np.exp(1j * back.wave_direction), np.exp(1j * hydro.wave_direction), atol=1e-5)
    for key in hydro.data_vars:
        for part in (np.real, np.imag):
            size = np.abs(hydro[key].values)
            assert np.all(np.abs(part(back[key].values) - part(hydro[key].values)) <= 2e-6 * size), key


# --- damage ---


@cache
def original() -> tuple[dict[str, bytes], xr.Dataset]:
    """The files of a set that the probe accepts, and what is read from them."""
    w, degrees = np.array([0.3, 0.5, 0.8, 1.1]), (0.0, 60.0, 180.0)
    h = body(w, degrees, seed=7, split=True)
    b, F = np.deg2rad(degrees), h.excitation_force.values.copy()
    C = h.hydrostatic_stiffness.values.copy()
    A, B = np.abs(h.added_mass.values), np.abs(h.radiation_damping.values)
    C[2, 2], A[:, 2, 2], B[:, 2, 2] = 3e7, 1e6, 1e5
    F[:, :, 0], F[:, :, 1] = 1j * w[:, None] ** 2 * 1e6 * np.cos(b), 1j * w[:, None] ** 2 * 1e6 * np.sin(b)
    F[:, :, 2] = (C[2, 2] - w**2 * A[:, 2, 2] + 1j * w * B[:, 2, 2])[:, None]
    dims = h.excitation_force.dims
    rng = np.random.default_rng(3)
    near, far = rng.normal(size=(2, *F.shape)) * 1e4
    far[..., 2:5] = np.nan
    h = h.assign(
        excitation_force=(dims, F),
        Froude_Krylov_force=(dims, 0.4 * F),
        diffraction_force=(dims, 0.6 * F),
        hydrostatic_stiffness=(h.hydrostatic_stiffness.dims, C),
        added_mass=(h.added_mass.dims, A),
        radiation_damping=(h.added_mass.dims, B),
        mean_drift_pressure=(dims, near),
        mean_drift_momentum=(dims, far),
    )
    with tempfile.TemporaryDirectory() as folder:
        paths = write_wamit(h, Path(folder) / "x")
        return {p.name.split(".", 1)[1]: p.read_bytes() for p in paths}, read_hydro(Path(folder) / "x")


def read_damaged(suffix: str, content: bytes) -> xr.Dataset | None:
    """Return what is read, or None where it is refused; any other exception is the test's failure."""
    files, _ = original()
    with tempfile.TemporaryDirectory() as folder:
        for other, raw in files.items():
            (Path(folder) / f"x.{other}").write_bytes(content if other == suffix else raw)
        try:
            return read_hydro(Path(folder) / "x")
        except (FormatError, ConventionError) as error:
            message = str(error)
    assert message.startswith(("x.", "x:")), message
    assert message.endswith((".", "better.")), message
    return None


def count_changes(new: xr.Dataset, old: xr.Dataset) -> int:
    """Return how many entries differ by more than 1e-4 of the largest of their variable and component."""
    assert set(new.data_vars) == set(old.data_vars)
    assert new.sizes == old.sizes
    np.testing.assert_allclose(new.omega, old.omega, rtol=2e-5)
    np.testing.assert_allclose(new.wave_direction, old.wave_direction, atol=1e-4)
    changes = 0
    for key in ("added_mass", "radiation_damping", "added_mass_zero", "added_mass_inf", "hydrostatic_stiffness", "motion_rao"):
        changes += _differing(new[key].values, old[key].values)
    for key in ("excitation_force", "mean_drift_pressure", "mean_drift_momentum"):
        changes += _differing(new[key].values, old[key].values)
    return changes


def _differing(x: np.ndarray, y: np.ndarray) -> int:
    assert np.array_equal(np.isnan(x), np.isnan(y))
    scale = np.nanmax(np.abs(y), initial=0.0)
    return int((np.nan_to_num(np.abs(x - y)) > 5e-3 * np.nan_to_num(np.abs(y)) + 3e-5 * scale).sum())


places = st.floats(0.0, 1.0, exclude_max=True)


@settings(max_examples=150, deadline=None)
@given(st.sampled_from(TABLES), places)
@example("1", 0.9999).via("the last newline")
def test_truncated_tables(suffix, place):
    """Cut anywhere: refused, unless nothing but line ends is lost."""
    files, old = original()
    raw = files[suffix]
    content = raw[: int(place * len(raw))]
    new = read_damaged(suffix, content)
    if new is not None:
        assert content.rstrip() == raw.rstrip()
        assert count_changes(new, old) == 0


@settings(max_examples=250, deadline=None)
@given(st.sampled_from(TABLES), places, st.integers(0, 255))
def test_one_wrong_byte_in_a_table(suffix, place, byte):
    """Refused, or no more than one row is other than it was: amplitude, phase and parts guard all files but .1 and .hst."""
    files, old = original()
    raw = bytearray(files[suffix])
    raw[int(place * len(raw))] = byte
    new = read_damaged(suffix, bytes(raw))
    if new is not None:
        assert count_changes(new, old) <= {"1": 2, "hst": 1}.get(suffix, 0)


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(TABLES), places, st.sampled_from(["delete", "double", "swap"]))
def test_lines_lost_doubled_or_exchanged(suffix, place, what):
    """A line too few or too many is refused; the order of lines does not matter."""
    files, old = original()
    lines = files[suffix].splitlines(keepends=True)
    k = int(place * len(lines))
    damaged = {
        "delete": lines[:k] + lines[k + 1 :],
        "double": lines[: k + 1] + lines[k:],
        "swap": [*lines[:k], *lines[k:][::-1]],
    }[what]
    new = read_damaged(suffix, b"".join(damaged))
    if what == "swap":
        assert new is not None
        assert count_changes(new, old) == 0
    else:
        assert new is None


@settings(max_examples=100, deadline=None)
@given(st.sampled_from(RUN_FILES), places, st.one_of(st.none(), st.integers(0, 255)))
def test_damaged_run_files(suffix, place, byte):
    """Cut or with a wrong byte: what can be read may have another number, never another shape, and nothing else is raised."""
    files, old = original()
    raw = bytearray(files[suffix])
    k = int(place * len(raw))
    if byte is None:
        del raw[k:]
    else:
        raw[k] = byte
    new = read_damaged(suffix, bytes(raw))
    if new is not None:
        assert new.sizes == old.sizes
        assert byte is not None or len(raw) >= len(files[suffix].rstrip()) - len("End of constants.")


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(TABLES + RUN_FILES), st.binary(max_size=300))
def test_garbage(suffix, content):
    new = read_damaged(suffix, content)
    assert new is None or not content.strip()


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(TABLES), st.text(alphabet="0123456789.+-EDed \n*nNaAiIfF", max_size=300))
def test_garbage_that_looks_like_numbers(suffix, content):
    assert read_damaged(suffix, content.encode()) is None
