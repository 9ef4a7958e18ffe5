"""The report: what it says, that it stands alone, and that its numbers are right."""

import numpy as np
import pytest
import xarray as xr

import ogilvie as og
from ogilvie.post.page import Picture, Section, Table, render_page
from ogilvie.post.report import Findings, describe, report
from ogilvie.post.report_figures import busiest
from ogilvie.post.report_tables import (
    body_table,
    check_table,
    memory_table,
    motion_rows,
    natural_periods,
    number,
    statistics_table,
)
from ogilvie.post.stats import summary


@pytest.fixture(scope="module")
def buoy():
    """Findings of a made-up buoy without a hull, with a run of known statistics."""
    w = np.linspace(0.05, 4.0, 60)
    K_hat = 1j * w / ((1j * w + 0.4) ** 2 + 1)
    A, B = np.zeros((60, 6, 6)), np.zeros((60, 6, 6))
    for i in range(6):
        A[:, i, i], B[:, i, i] = 1e5 * (2 + K_hat.imag / w), 1e5 * K_hat.real
    C = np.diag([0, 0, 4e5, 3e5, 3e5, 0])
    hydro = og.hydro_from_arrays(
        omega=w, added_mass=A, radiation_damping=B, added_mass_inf=2e5 * np.eye(6), hydrostatic_stiffness=C
    )
    K = og.retardation(hydro, duration=20.0, dt=0.1)
    body = og.RigidBody(3e5, [0.0, 0.0, -0.5], np.diag([3e5, 4e5, 5e5]))
    t = np.arange(0.0, 1000.0, 0.25)
    eta = 0.2 * np.cos(0.9 * t)[:, None] * np.ones(6)
    run = xr.Dataset({"eta": (("time", "dof"), eta)}, {"time": t, "dof": list(K.dofs)})
    run.attrs = {"dt": 0.25, "method": "rk4", "complete": 1, "seeds": []}
    ssm = og.identify(K, method="realization", order=2)
    return Findings("Buoy <1> & waves", body, hydro, K, ssm, run=run, statistics=summary(run), case_text="[sea]\nhs = 1 # <b>")


def test_titles_and_texts_are_escaped(buoy):
    page = report(buoy, pictures={})
    assert "<title>Buoy &lt;1&gt; &amp; waves</title>" in page
    assert "# &lt;b&gt;" in page


def test_what_is_missing_leaves_no_empty_section(buoy):
    page = report(buoy, pictures={})
    for absent in ("Overview", "Responses", ">Sea<"):
        assert absent not in page
    for there in ("Fluid memory", "Motions", "Case"):
        assert there in page


def test_pictures_are_inside_the_page(buoy):
    page = report(buoy, pictures={"motions": (b"\x89PNG123", "All <motions>")})
    assert 'src="data:image/png;base64,iVBORzEyMw=="' in page
    assert "<figcaption>All &lt;motions&gt;</figcaption>" in page


def test_the_page_prints_on_a4():
    page = render_page("x", [Section("y", ["z"])])
    assert "size: A4" in page
    assert "@media print" in page


def test_an_interrupted_run_is_called_so(buoy):
    from dataclasses import replace

    cut = buoy.run.assign_attrs(buoy.run.attrs | {"complete": 0})
    assert "INTERRUPTED" in report(replace(buoy, run=cut), pictures={})
    assert "INTERRUPTED" not in report(buoy, pictures={})


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (24015.3, "24015"),
        (0.01234, "0.01234"),
        (1.0, "1"),
        (0.0, "0"),
        (-2.54471, "-2.545"),
        (1.5e8, "1.500e8"),
        (2e-7, "2.000e-7"),
    ],
)
def test_numbers(value, text):
    assert number(value) == text


def test_natural_periods_balance_stiffness_and_inertia(buoy):
    found = natural_periods(buoy.hydro, buoy.body)
    assert set(found) == {"heave", "roll", "pitch"}
    w = 2 * np.pi / found["heave"]
    A = np.interp(w, buoy.hydro.omega, buoy.hydro.added_mass.values[:, 2, 2])
    assert w**2 * (buoy.body.mass + A) == pytest.approx(4e5, rel=1e-3)


def test_statistics_in_degrees_with_intervals(buoy):
    head, rows = motion_rows(buoy.statistics, None)
    by_name = {row[0]: dict(zip(head, row, strict=True)) for row in rows}
    assert by_name["heave"]["std"] == "0.141"
    assert by_name["roll"]["std"] == "8.1"
    assert by_name["roll"]["unit"] == "deg"
    assert by_name["heave"]["Tz, s"] == "6.98"
    low, high = map(float, by_name["heave"]["95 % interval"].split(" to "))
    assert low < 0.141 < high


def test_statistics_table_has_the_frequency_domain_beside_it(buoy):
    expected = xr.Dataset({"std": ("dof", np.full(6, 0.15))}, {"dof": list(buoy.K.dofs)})
    table = statistics_table(buoy.statistics, expected)
    assert all(len(row) == len(table.head) for row in table.rows)
    assert [row[5] for row in table.rows] == ["0.15"] * 3 + ["8.59"] * 3


def test_memory_table_and_sentence(buoy):
    table = memory_table(buoy.K, buoy.ssm)
    assert all(len(row) == len(table.head) for row in table.rows)
    assert table.head[-1] == "R\u00b2 of K"
    assert f"{buoy.ssm.order} states" in describe(buoy.ssm)
    assert "stable" in describe(buoy.ssm)
    assert "R\u00b2 of K" not in memory_table(buoy.K, None).head


def test_the_worst_coupling_of_a_model_is_named(buoy):
    from dataclasses import replace

    r2 = np.full((6, 6), 0.99)
    r2[2, 4] = -0.5
    assert "-0.5000 of K (heave-pitch)" in describe(replace(buoy.ssm, r2=r2))
    r2[3, 3] = -0.7
    assert "-0.7000 of K (roll)" in describe(replace(buoy.ssm, r2=r2))


def test_body_and_check_tables(buoy):
    rows = dict(body_table(buoy).rows)
    assert rows["mass"] == "300 t"
    assert rows["centre of gravity x, y, z"] == "0, 0, -0.5 m"
    checks = og.check(buoy.hydro)
    assert len(check_table(checks).rows) == len(checks.checks)


def test_tables_become_html():
    page = render_page(
        "x", [Section("y", tables=[Table([("a", "ok"), ("b", "WRONG")], ("name", "verdict"), left=frozenset({0, 1}))])]
    )
    assert '<td class="l ok">ok</td>' in page
    assert '<td class="l error">WRONG</td>' in page
    assert '<th class="l">name</th>' in page


def test_pictures_are_base64():
    assert Picture(b"abc", "").base64 == "YWJj"


def test_the_window_holds_the_largest_wave(buoy):
    t = buoy.run.time.values
    wave = np.exp(-(((t - 700.0) / 5.0) ** 2))
    run = buoy.run.assign(elevation=("time", wave))
    first, last = busiest(run)
    assert first < 700.0 < last
    assert last - first == pytest.approx(300.0)
    assert busiest(buoy.run) == (0.0, 300.0)


def test_motions_that_are_rounding_alone_are_zeros(buoy):
    eta = buoy.run.eta.copy()
    eta[:, 1] *= 1e-16
    moved = summary(buoy.run.assign(eta=eta))
    _, rows = motion_rows(moved, None)
    assert rows[1] == ["sway", "m", "0", "-", "0", "-"]
    assert rows[0][2] == "0.141"
    row = statistics_table(moved, None).rows[1]
    assert len(row) == len(statistics_table(moved, None).head)
    assert set(row[2:]) == {"0", "-"}
