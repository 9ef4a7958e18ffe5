"""The package from outside: public names, quick import, no side effects."""

import importlib.metadata
import os
import subprocess
import sys

import pytest

import ogilvie as og
from ogilvie.atomic import write_whole


@pytest.mark.parametrize("name", sorted(og._PUBLIC))
def test_public_name_resolves(name):
    assert getattr(og, name) is not None


def test_unknown_name_lists_the_public_ones():
    with pytest.raises(AttributeError, match="retardation"):
        og.retardatoin


def test_import_loads_nothing_heavy():
    heavy = ("numpy", "xarray", "numba", "scipy", "matplotlib", "capytaine")
    code = f"import sys, ogilvie; print([m for m in {heavy} if m in sys.modules])"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"


def test_version_is_the_distribution_s():
    assert importlib.metadata.version("ogilvie") == og.__version__


@pytest.mark.parametrize("what", ["folder", "pipe"])
def test_only_files_are_replaced(tmp_path, what):
    """Neither a folder nor a device gives way to a file that is written."""
    target = tmp_path / what
    target.mkdir() if what == "folder" else os.mkfifo(target)
    with pytest.raises(og.InputError, match="the place of a file expected"):
        write_whole(target, lambda path: path.write_text("x"))
    assert target.exists()
    assert not target.is_file()
