"""Time to identify the passive fluid memory of five vessels, beside vector fitting without passivity on the same data.

One thread; processor time, so that what else the machine does counts little. Each figure is the best of a few calls of
`identify` alone: the retardation functions are ready, compiled functions are loaded. The order that is given is what the vessel
needs per block. The baseline is the package's own vector fitting (`method="vector", passive=False`), which chooses its order
for the same R2: it knows nothing of the motion and its models are not passive.
"""

import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import ogilvie as og
from benchmarks import Measurement

DATA = Path(__file__).resolve().parents[2] / "shared" / "reference" / "radiation"
ORDER = {"fpso": 18, "tanker": 14, "semisub": 10, "s175": 10, "supply": 10}  # states of each block
REPEAT = 3


def seconds(work: Callable[[], Any]) -> tuple[float, Any]:
    """Return the processor time of the best of a few calls, and what the last returned."""
    best, result = np.inf, None
    for _ in range(REPEAT):
        begin = time.process_time()
        result = work()
        best = min(best, time.process_time() - begin)
    return best, result


def of_vessel(name: str) -> list[Measurement]:
    """Return the measurements of one vessel."""
    d = np.load(DATA / f"{name}.npz")
    some = d["omega"] > 0
    hydro = og.hydro_from_arrays(
        omega=d["omega"][some],
        added_mass=d["added_mass"][some],
        radiation_damping=d["radiation_damping"][some],
        added_mass_inf=d["added_mass_inf"] if "added_mass_inf" in d.files else None,
        name=name,
    )
    K, motion = og.retardation(hydro), {"mass": d["mass"], "stiffness": d["stiffness"]}
    og.identify(K, order=2)
    plain, vector = seconds(lambda: og.identify(K, method="vector", passive=False))
    given, fixed = seconds(lambda: og.identify(K, order=ORDER[name], **motion))
    own, chosen = seconds(lambda: og.identify(K, **motion))
    assert fixed.is_passive
    assert chosen.is_passive
    baseline = "vector fitting's time"
    return [
        Measurement(f"{name}: vector fitting, not passive", plain, "s", None, "", f"{vector.order} states"),
        Measurement(f"{name}: order given", given, "s", given / plain, baseline, f"{fixed.order} states, target < 1 s"),
        Measurement(f"{name}: order chosen", own, "s", own / plain, baseline, f"{chosen.order} states, target < 3 s"),
    ]


def measure() -> list[Measurement]:
    """Return the measurements; none where the data are not present."""
    if not DATA.is_dir():
        print("identification: needs 'shared/reference/radiation' beside the project; skipped")
        return []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", og.OgilvieWarning)
        return [row for name in ORDER for row in of_vessel(name)]
