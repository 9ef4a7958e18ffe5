"""Which frequencies are left out, what is said of the rest: made-up damage, clean data, real data sets."""

import numpy as np
import pytest

import ogilvie as og

OMEGA = np.linspace(0.05, 4.0, 80)


def smooth(omega=OMEGA, *, dofs=("heave",), change=None):
    """Added mass and damping of K = exp(-0.4 t) (cos t - 0.4 sin t), K_hat = s / ((s + 0.4)^2 + 1); `change` damages them."""
    K_hat = 1j * omega / ((1j * omega + 0.4) ** 2 + 1)
    A, B = 2 + K_hat.imag / omega, K_hat.real
    if change is not None:
        change(A, B)
    square = np.ones((1, len(dofs), len(dofs))) * np.eye(len(dofs))
    return og.hydro_from_arrays(
        omega=omega, added_mass=A[:, None, None] * square, radiation_damping=B[:, None, None] * square, dofs=dofs
    )


def test_clean_data_lose_nothing():
    K = og.retardation(smooth())
    assert K.mask.all()
    assert not [note for note in K.notes if "Kramers" in note or "spike" in note or "definite" in note]


def test_exact_hemisphere_loses_nothing(shared_reference):
    rows = [x.split(",") for x in (shared_reference / "hemisphere_exact.csv").read_text().splitlines() if x[:1].isdigit()]
    d = np.array(rows, dtype=float)
    omega = np.sqrt(d[:, 0])
    A, B = np.zeros((2, len(omega), 2, 2))
    for i, (mu, lam) in enumerate(((3, 4), (1, 2))):
        A[:, i, i], B[:, i, i] = d[:, mu], d[:, lam] * omega
    for last in (10.0, np.inf):
        some = d[:, 0] <= last
        h = og.hydro_from_arrays(omega=omega[some], added_mass=A[some], radiation_damping=B[some], dofs=("surge", "heave"))
        assert og.retardation(h).mask.all()


def test_clean_band_of_the_tanker_loses_nothing(shared_reference):
    """Only what is not positive semi-definite goes; every frequency below 3.6 rad/s stays."""
    d = np.load(shared_reference / "radiation" / "tanker.npz")
    some = (d["omega"] > 0) & (d["omega"] < 3.6)
    h = og.hydro_from_arrays(
        omega=d["omega"][some],
        added_mass=d["added_mass"][some],
        radiation_damping=d["radiation_damping"][some],
        added_mass_inf=d["added_mass_inf"],
    )
    assert og.retardation(h).mask.all()


@pytest.mark.parametrize("at", [0, 20, 40])
def test_added_mass_that_cannot_belong_is_left_out_and_named(at):
    def halved(A, B):
        A[at] *= 0.5

    K = og.retardation(smooth(change=halved))
    assert np.array_equal(np.flatnonzero(~K.mask), [at])
    note = next(n for n in K.notes if n.startswith("added mass unlike"))
    assert f"omega {OMEGA[at]:.4g} rad/s: left out" in note


@pytest.mark.parametrize("name", ["s175", "supply"])
def test_first_frequency_of_the_strip_theory_sets_is_left_out(shared_reference, name):
    d = np.load(shared_reference / "radiation" / f"{name}.npz")
    h = og.hydro_from_arrays(omega=d["omega"], added_mass=d["added_mass"], radiation_damping=d["radiation_damping"])
    K = og.retardation(h)
    assert np.array_equal(np.flatnonzero(~K.mask), [0])
    assert any("0.1047" in note for note in K.notes)


def test_all_frequencies_are_kept_where_the_user_says_so_and_their_damage_is_named():
    def damaged(A, B):
        A[20] *= 0.5
        B[60] = -0.1

    K = og.retardation(smooth(change=damaged), frequencies="all")
    assert K.mask.all()
    assert sum("kept" in note for note in K.notes) >= 2
    chosen = np.arange(80) != 20
    K = og.retardation(smooth(change=damaged), frequencies=chosen)
    assert np.array_equal(K.mask, chosen)
    assert not any(note.startswith("added mass unlike") for note in K.notes)


def test_spikes_and_contradictions_are_reported():
    def spike(A, B):
        B[40] += 0.3

    def other(A, B):
        A += 0.5 * np.sin(3 * OMEGA)

    assert any(note.startswith("spikes") and f"{OMEGA[40]:.4g}" in note for note in og.retardation(smooth(change=spike)).notes)
    note = next(n for n in og.retardation(smooth(change=other)).notes if "contradict" in n)
    assert "heave" in note
    assert "%" in note
