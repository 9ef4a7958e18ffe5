"""Run the benchmarks, print a table, write a JSON file to benchmarks/results."""

import importlib
import json
import os
import pkgutil
import platform
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path

import benchmarks
from benchmarks import Measurement

RESULTS = Path(benchmarks.__file__).parent / "results"


def main(arguments: Sequence[str]) -> int:
    """Run the modules named in the arguments, or all; return the exit code."""
    present = sorted(m.name for m in pkgutil.iter_modules(benchmarks.__path__) if not m.name.startswith("_"))
    unknown = set(arguments) - set(present)
    if unknown:
        print(f"benchmarks: names out of {', '.join(present)} expected, {', '.join(sorted(unknown))} found.", file=sys.stderr)
        return 2
    found = {}
    for name in arguments or present:
        module = importlib.import_module(f"benchmarks.{name}")
        if hasattr(module, "measure"):
            found[name] = module.measure()
            print_table(name, found[name])
    print(f"\nwritten to {write(found)}")
    return 0


def print_table(name: str, measurements: Sequence[Measurement]) -> None:
    """Print the measurements of one module."""
    print(f"\n{name}")
    for m in measurements:
        ratio = f"{m.ratio:8.1f} x {m.baseline}" if m.ratio is not None else ""
        print(f"  {m.name:48} {m.value:14,.4g} {m.unit:10} {ratio}{f'  ({m.note})' if m.note else ''}")


def write(found: dict[str, list[Measurement]]) -> Path:
    """Write all measurements with date and machine to a JSON file."""
    now = datetime.now(UTC)
    record = {
        "date": now.isoformat(timespec="seconds"),
        "python": platform.python_version(),
        "machine": platform.machine(),
        "cores": len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count(),
        "measurements": {name: [asdict(m) for m in rows] for name, rows in found.items()},
    }
    RESULTS.mkdir(exist_ok=True)
    path = RESULTS / f"{now:%Y%m%d-%H%M%S}.json"
    handle, part = tempfile.mkstemp(dir=RESULTS, suffix=".part")
    with os.fdopen(handle, "w") as file:
        json.dump(record, file, indent=1)
    os.replace(part, path)
    return path


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
