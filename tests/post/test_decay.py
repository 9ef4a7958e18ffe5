"""Decay analysis: closed forms of damping, intervals that hold, noise, offsets, a measured series."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from ogilvie.errors import InputError
from ogilvie.post.decay import decay
from ogilvie.post.decay_fit import fit_decay, residual_inflation, trajectory


def linear_decay(t, *, x0=0.2, omega=0.3, ratio=0.02):
    """Release from rest of a linearly damped oscillator, exact."""
    s, w = ratio * omega, omega * np.sqrt(1 - ratio**2)
    return x0 * np.exp(-s * t) * (np.cos(w * t) + s / w * np.sin(w * t))


def simulated(t, *, x0=0.2, v0=0.0, omega=0.3, e=0.0, b1=0.0, b2=0.0, b3=0.0):
    """The model integrated by another code."""

    def rate(_, y):
        x, v = y
        return [v, -(omega**2) * (x + e * x**3) - b1 * v - b2 * abs(v) * v - b3 * v**3]

    return solve_ivp(rate, (t[0], t[-1]), [x0, v0], t_eval=t, rtol=1e-10, atol=1e-13, method="DOP853").y[0]


T = np.arange(0.0, 250.0, 0.4)  # 12 cycles of 21 s


@pytest.mark.parametrize("ratio", [0.002, 0.02, 0.1, 0.25])
def test_linear_decay_is_found_exactly(ratio):
    """Logarithmic decrement, period and coefficient of every cycle are those of the closed form."""
    found = decay(T, linear_decay(T, ratio=ratio), model="linear")
    assert np.allclose(found.damping_ratio, ratio, rtol=2e-6)
    assert np.allclose(found.period, 2 * np.pi / (0.3 * np.sqrt(1 - ratio**2)), rtol=1e-7)
    assert np.isclose(found.linear.value, 2 * ratio * 0.3, rtol=1e-6)
    assert np.isclose(found.natural_frequency.value, 0.3, rtol=1e-7)
    assert np.allclose(found.equivalent_damping_ratio(found.amplitude), ratio, rtol=1e-6)
    assert found.r2 > 1 - 1e-12
    assert found.quadratic.value == found.cubic.value == found.stiffening.value == 0.0


def test_extrema_of_quadratic_damping_obey_the_exact_first_integral():
    """(1 + 2 b a_k) exp(-2 b a_k) = (1 - 2 b a_k+1) exp(2 b a_k+1): x' squared obeys a linear equation in each half cycle."""
    b = 0.8
    found = decay(T, simulated(T, b2=b), model="quadratic")
    a = np.abs(found.peak)
    left, right = (1 + 2 * b * a[:-1]) * np.exp(-2 * b * a[:-1]), (1 - 2 * b * a[1:]) * np.exp(2 * b * a[1:])
    loss = 1 - left  # what a half cycle changes, to be met to 0.1 %; to 2 % where only one side of an extremum is seen
    assert np.all((np.abs(left - right) < 1e-3 * loss)[1:-1])
    assert np.all(np.abs(left - right) < 0.02 * loss)
    assert np.isclose(found.quadratic.value, b, rtol=1e-6)


def test_amplitude_law_of_quadratic_damping():
    """1/a grows by 4/3 b2 per half cycle, i.e. at the rate 4/(3 pi) b2 omega, as the damping becomes small."""
    t = np.arange(0.0, 900.0, 0.4)
    found = decay(t, simulated(t, b2=0.05), model="quadratic")
    growth = np.polyfit(found.peak_time, 1 / np.abs(found.peak), 1)[0]
    assert np.isclose(growth, 4 / (3 * np.pi) * 0.05 * 0.3, rtol=2e-3)
    assert np.allclose(found.damping_ratio[1:-1], found.equivalent_damping_ratio(found.amplitude)[1:-1], rtol=3e-3)


def test_amplitude_law_of_cubic_damping():
    """1/a^2 grows at the rate 3/4 b3 omega^2."""
    t = np.arange(0.0, 900.0, 0.4)
    found = decay(t, simulated(t, b3=1.5), model="cubic")
    growth = np.polyfit(found.peak_time, 1 / found.peak**2, 1)[0]
    assert np.isclose(growth, 0.75 * 1.5 * 0.3**2, rtol=2e-3)
    assert np.allclose(found.damping_ratio[1:-1], found.equivalent_damping_ratio(found.amplitude)[1:-1], rtol=3e-3)


def test_period_of_a_stiffening_restoring():
    """T/T0 = 1 - 3/8 e a^2 + 57/256 (e a^2)^2 (Duffing), and e is found."""
    found = decay(T, simulated(T, e=1.2, b2=0.05), model="quadratic", restoring="cubic")
    assert np.isclose(found.stiffening.value, 1.2, rtol=1e-4)
    strength = 1.2 * found.amplitude**2
    expected = 1 - 3 / 8 * strength + 57 / 256 * strength**2
    assert np.allclose((found.period / found.natural_period)[1:-1], expected[1:-1], atol=1e-4)


@pytest.mark.parametrize(
    "b",
    [(0.01, 0.0, 0.0), (0.0, 0.4, 0.0), (0.0, 0.0, 3.0), (0.004, 0.3, 0.0), (0.004, 0.0, 2.0), (0.004, 0.2, 2.0)],
)
def test_coefficients_are_recovered(b):
    """Every combination of damping terms, from series that another code integrated, with offset and drift."""
    model = "+".join(name for name, value in zip(("linear", "quadratic", "cubic"), b, strict=True) if value)
    x = simulated(T, b1=b[0], b2=b[1], b3=b[2]) + 0.03 + 1e-4 * T
    found = decay(T, x, model=model, offset="drift", start=0.0)
    assert np.allclose([found.linear.value, found.quadratic.value, found.cubic.value], b, rtol=1e-4)
    assert np.isclose(found.offset.value, 0.03, rtol=1e-5)
    assert np.isclose(found.drift.value, 1e-4, rtol=1e-4)
    assert np.allclose(found.fit, found.x, atol=1e-7)


def test_sensitivities_of_the_simulated_decay():
    """The Jacobian that the intervals rest on, against central differences."""
    t, p = np.linspace(0.0, 80.0, 200), np.array([0.2, 0.01, 0.09, 0.8, 0.01, 0.3, 2.0])
    J = trajectory(t, p, 0.1)[1]
    for k in range(len(p)):
        h = 1e-5 * max(abs(p[k]), 0.1) * (np.arange(len(p)) == k)
        numeric = (trajectory(t, p + h, 0.1)[0] - trajectory(t, p - h, 0.1)[0]) / (2 * h[k])
        assert np.allclose(J[:, k], numeric, atol=1e-5 * np.abs(J[:, k]).max())


def test_simulated_decay_converges_with_order_four():
    t, p = np.linspace(0.0, 60.0, 4), np.array([0.2, 0.0, 0.09, 0.5, 0.01, 0.0, 2.0])
    exact = trajectory(t, p, 0.01)[0]
    coarse, fine = (np.abs(trajectory(t, p, h)[0] - exact).max() for h in (2.0, 1.0))
    assert 3.6 < np.log2(coarse / fine) < 4.6


@pytest.mark.parametrize("memory", [0.0, 0.9])
def test_intervals_cover_the_truth(memory):
    """95 % intervals hold the true coefficients in about 95 % of 150 noisy series, white noise or correlated."""
    rng = np.random.default_rng(11)
    x = simulated(T, b1=0.005, b2=0.3)
    start = {"x0": 0.2, "stiffness": 0.09, "linear": 0.01}
    inside = np.zeros(3)
    for _ in range(150):
        noise = 0.01 * rng.standard_normal(len(T))
        for k in range(1, len(T)):
            noise[k] += memory * noise[k - 1]
        found = fit_decay(T, x + noise, terms=("linear", "quadratic"), stiffening=False, drift=False, fixed=None, start=start)
        for k, (name, truth) in enumerate((("linear", 0.005), ("quadratic", 0.3), ("stiffness", 0.09))):
            inside[k] += abs(found.values[name] - truth) < found.errors[name]
    assert np.all(inside / 150 > 0.89)
    assert np.all(inside / 150 < 0.995)


def test_residual_inflation_is_the_spectral_density_of_an_autoregression():
    """x_k = c x_k-1 + noise has density (1 - c^2) / |1 - c exp(-i angle)|^2 over its mean."""
    rng, c, angle = np.random.default_rng(3), 0.95, 0.05
    r = np.zeros(60_000)
    noise = rng.standard_normal(len(r))
    for k in range(1, len(r)):
        r[k] = c * r[k - 1] + noise[k]
    expected = (1 - c**2) / abs(1 - c * np.exp(-1j * angle)) ** 2
    assert np.isclose(residual_inflation(r, angle)[0], expected, rtol=0.15)


@pytest.mark.parametrize("seed", range(4))
def test_noise_does_not_add_extrema(seed):
    """With noise of 8 % of the first amplitude: one extremum per half cycle, signs alternate, periods within 6 %."""
    noise = 0.016 * np.random.default_rng(seed).standard_normal(len(T))
    found = decay(T, linear_decay(T) + noise, model="linear")
    assert 20 <= len(found.peak) <= 24
    assert np.all(found.peak[:-1] * found.peak[1:] < 0)
    assert np.allclose(found.period, 2 * np.pi / 0.3, rtol=0.06)
    exact = 0.2 * np.exp(-0.02 * 0.3 * found.peak_time)
    assert np.abs(np.abs(found.peak) - exact).max() < 0.012
    assert abs(found.linear.value - 0.012) < 2 * found.linear.error


def test_extrema_end_where_the_noise_begins():
    t = np.arange(0.0, 600.0, 0.4)
    noise = 0.004 * np.random.default_rng(5).standard_normal(len(t))
    found = decay(t, linear_decay(t, ratio=0.05) + noise, model="linear")
    assert 0.001 < np.abs(found.peak[-1]) < 0.01
    assert np.isclose(found.linear.value, 0.03, rtol=0.05)


def test_the_free_part_is_found_after_a_quiet_beginning():
    """At rest, pushed over, let go at 40 s: the analysis begins at the largest excursion."""
    push = 0.1 * (1 - np.cos(np.pi * np.arange(0.0, 10.0, 0.4) / 10.0))
    x = np.concatenate([np.zeros(75), push, linear_decay(T)])
    t = 0.4 * np.arange(len(x))
    found = decay(t, x, model="linear")
    assert np.isclose(found.t[0], 40.0, atol=0.5)
    assert np.isclose(found.linear.value, 0.012, rtol=1e-6)


def test_uneven_sampling_changes_nothing():
    t = np.sort(np.random.default_rng(9).uniform(0.0, 250.0, 1500))
    found = decay(t, linear_decay(t), model="linear", start=0.0)
    assert np.isclose(found.linear.value, 0.012, rtol=1e-6)
    assert np.allclose(found.damping_ratio, 0.02, rtol=1e-4)


def test_change_of_scale():
    """Froude's law: time by sqrt(s), b1 by 1/sqrt(s), b2 and damping ratios unchanged; and the mirror image."""
    x = simulated(T, b1=0.004, b2=0.3)
    model, ship = decay(T, x), decay(T * np.sqrt(68), -x)
    assert np.isclose(ship.natural_period, model.natural_period * np.sqrt(68), rtol=1e-6)
    assert np.isclose(ship.linear.value, model.linear.value / np.sqrt(68), rtol=1e-4)
    assert np.isclose(ship.quadratic.value, model.quadratic.value, rtol=1e-5)
    assert np.allclose(ship.damping_ratio, model.damping_ratio, rtol=1e-4)
    assert np.allclose(ship.peak, -model.peak, rtol=1e-5)


def test_coefficients_in_si():
    """inertia multiplies; stiffness gives the inertia by the natural frequency."""
    x = simulated(T, b1=0.004, b2=0.3)
    bare, by_inertia, by_stiffness = decay(T, x), decay(T, x, inertia=5e9), decay(T, x, stiffness=5e9 * 0.09)
    assert by_inertia.quadratic.value == pytest.approx(5e9 * bare.quadratic.value)
    assert by_stiffness.inertia == pytest.approx(5e9, rel=1e-6)
    assert by_stiffness.linear.value == pytest.approx(by_inertia.linear.value, rel=1e-6)
    assert np.allclose(by_inertia.equivalent_damping_ratio(0.1), bare.equivalent_damping_ratio(0.1))
    assert bare.inertia is None


def test_known_offset_is_kept():
    found = decay(T, linear_decay(T) + 0.02, model="linear", offset=0.02)
    assert (found.offset.value, found.offset.error) == (0.02, 0.0)
    assert np.isclose(found.linear.value, 0.012, rtol=1e-6)


def test_table():
    text = str(decay(T, simulated(T, b1=0.004, b2=0.3), stiffness=1e9))
    assert "natural period 20.944" in text
    assert "kg m2/s" in text
    assert "deg" in text
    assert len(text.splitlines()) < 22
    heave = str(decay(T, simulated(T, b2=0.3), dof="heave", model="quadratic"))
    assert "1/m" in heave
    assert "deg" not in heave


def test_a_poor_model_is_said():
    """A wandering mean position that no model here has; and a term that the series does not determine."""
    x = linear_decay(T) + 0.03 * np.sin(0.031 * T)
    assert any("explains" in note for note in decay(T, x, model="linear").notes)
    noise = 0.01 * np.random.default_rng(2).standard_normal(len(T))
    found = decay(T, linear_decay(T) + noise, model="linear+quadratic+cubic")
    assert any("not told from zero" in note for note in found.notes)
    misfit = decay(T, simulated(T, e=3.0, b1=0.002), model="linear")
    assert any("restoring='cubic'" in note for note in misfit.notes)


def test_measured_roll_decay_of_kvlcc2(shared_data):
    """Model of KVLCC2 (SSPA 2018, 1:68): 2.55 s; at small angles 21.05 s full scale, shorter at large ones; R2 0.9999."""
    d = np.genfromtxt(shared_data / "kvlcc2_rolldecay" / "model_test_21337.csv", delimiter=",", names=True)
    assert decay(d["time"], d["phi"]).t[0] == pytest.approx(25.0, abs=0.1)  # where the model was let go
    found = decay(d["time"], d["phi"], restoring="cubic", start=27.4)  # two half cycles later
    assert np.isclose(np.median(found.period), 2.55, atol=0.01)
    assert found.r2 > 0.9999
    assert 0.7 < found.stiffening.value < 1.0  # wall-sided: BM/(2 GM) - 1/6 = 1.0
    assert np.abs(found.equivalent_damping_ratio(found.amplitude) - found.damping_ratio).max() < 0.0015


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"t": T[:-1]}, "one length"),
        ({"x": np.full(len(T), np.nan)}, "NaN"),
        ({"t": T[::-1]}, "ascending"),
        ({"x": np.zeros(len(T))}, "a motion"),
        ({"start": 1e4}, "a motion"),
        ({"end": 20.0}, "cycles"),
        ({"dof": "rolling"}, "dof"),
        ({"model": "quartic"}, "model"),
        ({"model": "linear+linear"}, "model"),
        ({"offset": "mean"}, "offset"),
        ({"restoring": "none"}, "restoring"),
        ({"inertia": -1.0}, "positive"),
        ({"inertia": 1.0, "stiffness": 1.0}, "both found"),
    ],
)
def test_bad_input(change, words):
    arguments = {"t": T, "x": linear_decay(T), **change}
    with pytest.raises(InputError, match=words):
        decay(arguments.pop("t"), arguments.pop("x"), **arguments)


def test_too_few_samples_per_cycle():
    t = np.arange(0.0, 600.0, 4.0)
    with pytest.raises(InputError, match="samples"):
        decay(t, linear_decay(t))
