"""The cache on disk: whole or not at all, never wrong, never in the way."""

import os
from pathlib import Path

import numpy as np
import pytest

from ogilvie.errors import OgilvieWarning
from ogilvie.hydro import bem_store
from ogilvie.hydro import capytaine as solver
from ogilvie.hydro.cache import Cache, cache_folder, content_key, fill_folder, prune, write_whole
from ogilvie.hydro.progress import tracked
from ogilvie.mesh.panels import PanelMesh

# ---- entries


def test_stored_arrays_come_back_to_the_bit(tmp_path):
    cache = Cache(tmp_path / "problem")
    arrays = {"z": np.array([1.5 - 2j, np.pi]), "n": np.arange(6).reshape(2, 3)}
    assert cache.load("a") is None
    cache.store("a", arrays)
    found = cache.load("a")
    assert found.keys() == arrays.keys()
    for key in arrays:
        np.testing.assert_array_equal(found[key], arrays[key])
    assert [p.name for p in (tmp_path / "problem").iterdir()] == ["a.npz"]  # no temporary files left


@pytest.mark.parametrize(
    "damage",
    [
        lambda data: b"",
        lambda data: data[: len(data) // 2],
        lambda data: b"not an archive" * 10,
        lambda data: data[:200] + bytes(b ^ 0xFF for b in data[200:240]) + data[240:],
    ],
    ids=["empty", "cut", "text", "flipped bits"],
)
def test_damaged_entry_is_reported_and_treated_as_missing(tmp_path, damage):
    cache = Cache(tmp_path)
    cache.store("a", {"x": np.linspace(0.0, 1.0, 50)})
    path = tmp_path / "a.npz"
    path.write_bytes(damage(path.read_bytes()))
    with pytest.warns(OgilvieWarning, match=r"a\.npz cannot be read"):
        assert cache.load("a") is None
    cache.store("a", {"x": np.zeros(3)})
    assert cache.load("a")["x"].tolist() == [0.0, 0.0, 0.0]


def test_pickled_objects_are_not_loaded(tmp_path):
    np.savez(tmp_path / "a.npz", x=np.array([{"a": 1}], dtype=object))
    with pytest.warns(OgilvieWarning, match="cannot be read"):
        assert Cache(tmp_path).load("a") is None


def test_failed_write_leaves_the_old_entry_and_no_rubbish(tmp_path, monkeypatch):
    path = tmp_path / "a.npz"
    write_whole(path, {"x": np.ones(2)})

    def interrupted(*args, **kwargs):
        raise KeyboardInterrupt

    monkeypatch.setattr(np, "savez", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_whole(path, {"x": np.zeros(2)})
    monkeypatch.undo()
    assert Cache(tmp_path).load("a")["x"].tolist() == [1.0, 1.0]
    assert [p.name for p in tmp_path.iterdir()] == ["a.npz"]


def test_cache_that_cannot_be_written_is_a_warning(tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.warns(OgilvieWarning, match="cannot be written"):
        Cache(tmp_path / "file" / "problem").store("a", {"x": np.ones(1)})


def test_keys_tell_everything_apart():
    parts = [
        ("a", np.zeros(3)),
        ("b", np.zeros(3)),
        ("a", np.zeros(4)),
        ("a", np.zeros((3, 1))),
        ("a", np.zeros(3, dtype=np.float32)),
        ("a", np.array([0.0, 0.0, 1e-300])),
        ("a", np.zeros(3), 1.0),
        ("a", np.zeros(3), 2.0),
        ("a", np.zeros(3), np.inf),
        ("a", "", np.zeros(3)),
    ]
    assert len({content_key(*p) for p in parts}) == len(parts)


def test_prune_removes_what_was_not_used_for_longest(tmp_path):
    for i, name in enumerate(("old", "middle", "new")):
        Cache(tmp_path / name).store("a", {"x": np.zeros(1000)})
        os.utime(tmp_path / name, (1e9 + i, 1e9 + i))
    assert prune(tmp_path, limit=10**9) == 0
    assert prune(tmp_path, limit=10_000) > 0
    assert sorted(p.name for p in tmp_path.iterdir()) == ["new"]
    assert prune(tmp_path, limit=0) == 0  # what is in use stays


def test_folder_follows_the_environment(tmp_path, monkeypatch):
    monkeypatch.setenv("OGILVIE_CACHE", str(tmp_path))
    assert cache_folder() == tmp_path
    monkeypatch.delenv("OGILVIE_CACHE")
    assert cache_folder().name == "ogilvie"


def test_folder_is_filled_whole_or_not_at_all(tmp_path):
    def half(folder: Path):
        (folder / "x").write_text("half")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fill_folder(tmp_path / "table", half)
    assert list(tmp_path.iterdir()) == []
    fill_folder(tmp_path / "table", lambda folder: (folder / "x").write_text("whole"))
    assert (tmp_path / "table" / "x").read_text() == "whole"
    fill_folder(tmp_path / "table", lambda folder: (folder / "x").write_text("second"))  # another process was faster
    assert (tmp_path / "table" / "x").read_text() in ("whole", "second")
    assert [p.name for p in tmp_path.iterdir()] == ["table"]


# ---- solve_bem with the cache

BOX = PanelMesh(
    [[2.0, 0, -1], [2, 1, -1], [0, 1, -1], [0, 0, -1], [2, 0, 0], [2, 1, 0], [0, 1, 0]],
    [[0, 3, 2, 1], [1, 2, 6, 5], [0, 1, 5, 4]],
    symmetry="xz+yz",
    name="box",
    lid=PanelMesh([[0.0, 0, 0], [0, 1, 0], [2, 1, 0], [2, 0, 0]], [[0, 1, 2, 3]], symmetry="xz+yz"),
)
W = [0.5, 0.8, 1.1]


@pytest.fixture
def solved(tmp_path, monkeypatch):
    """List of the wavenumbers that were solved, with an empty cache for them."""
    calls = []
    original = solver._influence

    def counted(green, panels, k, depth, mirror):
        if np.all(mirror > 0.0):
            calls.append(k)
        return original(green, panels, k, depth, mirror)

    monkeypatch.setattr(bem_store, "cache_folder", lambda: tmp_path)
    monkeypatch.setattr(solver, "_influence", counted)
    return calls


def run(**change):
    return solver.solve_bem(**{"hull": BOX, "omega": W, "workers": 1, "progress": False, **change})


def test_second_run_solves_nothing_and_is_equal(solved):
    first = run()
    assert len(solved) == 5  # three frequencies, zero, infinity
    solved.clear()
    second = run()
    assert solved == []
    for name in first.data_vars:
        np.testing.assert_array_equal(first[name], second[name])
    np.testing.assert_allclose(run(cache=False).added_mass, first.added_mass, rtol=1e-12)


def test_only_what_is_new_is_solved(solved):
    run()
    solved.clear()
    run(wave_direction=[0.0, 1.0, 2.0], rho=1000.0)
    run(hull=BOX.named("another name"))
    assert solved == []
    run(omega=[0.6, *W])
    assert len(solved) == 1
    solved.clear()
    run(speed=1.0)  # encounter frequencies in head seas
    assert len(solved) == 3
    solved.clear()
    run(irregular_frequencies="keep")
    assert len(solved) == 3  # zero and infinite frequency need no lid in any case
    solved.clear()
    run(water_depth=50.0)
    assert len(solved) == 4
    solved.clear()
    run(hull=BOX.translated([0.0, 0.0, 0.0]).scaled(1.0 + 1e-9))
    assert len(solved) == 5


def test_interrupted_run_goes_on_where_it_stopped(solved, monkeypatch):
    original = solver.force_vectors
    count = iter(range(100))

    def interrupted(panels, influence, *, K):
        if next(count) == 3:
            raise KeyboardInterrupt
        return original(panels, influence, K=K)

    monkeypatch.setattr(solver, "force_vectors", interrupted)
    with pytest.raises(KeyboardInterrupt):
        run()
    monkeypatch.setattr(solver, "force_vectors", original)
    assert len(solved) == 3
    run()
    assert len(solved) == 5


def test_damaged_solution_is_solved_again(solved, tmp_path):
    first = run()
    solved.clear()
    for path in tmp_path.rglob("*.npz"):
        path.write_bytes(path.read_bytes()[:100])
        break
    with pytest.warns(OgilvieWarning, match="computed again"):
        again = run()
    assert len(solved) == 1
    np.testing.assert_array_equal(again.added_mass, first.added_mass)


def test_solution_of_another_shape_is_not_used(solved, tmp_path):
    run()
    solved.clear()
    path = next(tmp_path.rglob("*.npz"))
    write_whole(path, {"force_vectors": np.zeros((6, 1), dtype=complex)})
    run()
    assert len(solved) == 1


# ---- progress


def test_bar_is_shown_when_asked_for_and_closed_on_interruption(capsys):
    assert list(tracked([1, 2], show=True, title="solving box")) == [1, 2]
    assert "solving box" in capsys.readouterr().err
    generator = tracked([1, 2, 3], show=True)
    next(generator)
    generator.close()
    assert list(tracked([1, 2], show=None)) == [1, 2]  # no terminal here
    assert capsys.readouterr().out == ""
