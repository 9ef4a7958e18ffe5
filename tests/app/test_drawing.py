"""Figures are drawn by a second process, and by the first one where that cannot be."""

import numpy as np
import pytest

from ogilvie.app import drawing
from ogilvie.app.drawing import Painter
from ogilvie.errors import InputError
from ogilvie.post import plot
from ogilvie.post.report_figures import Job


def line(data, fig):
    fig.add_subplot().plot(data)


@pytest.fixture
def jobs():
    run = np.arange(5.0)
    return {name: Job(plot.custom, (line, run), f"caption {name}") for name in "abc"}


@pytest.mark.parametrize("kind", ["own process", "no process", "broken process"])
def test_every_figure_is_drawn_in_its_place(kind, jobs, monkeypatch):
    if kind == "broken process":
        monkeypatch.setattr(drawing, "_MODULE", "ogilvie.no_such_module")
    with Painter(wanted=kind != "no process") as painter:
        painter.draw({"a": jobs["a"]})
        painter.draw({name: jobs[name] for name in "bc"})
        drawn = painter.finish()
    assert list(drawn) == ["a", "b", "c"]
    assert all(png.startswith(b"\x89PNG") and caption == f"caption {name}" for name, (png, caption) in drawn.items())


def test_errors_come_up_in_the_first_process(jobs):
    with Painter() as painter:
        painter.draw(jobs | {"bad": Job(plot.spectrum, (None,), "")})
        with pytest.raises(InputError, match="a spectrum, a sea or both"):
            painter.finish()


def test_the_other_process_ends_when_work_is_given_up(jobs):
    with Painter() as painter:
        painter.draw(jobs)
        process = painter.process
    assert process is None or process.wait(timeout=20) is not None


class Noting:
    """Notes what it computes in itself while it is being packed, as a mesh does."""

    def __init__(self):
        self.values = np.arange(5.0)

    def __array__(self, dtype=None, copy=None):
        return self.values


def test_what_is_drawn_may_note_results_meanwhile():
    thing = Noting()
    with Painter() as painter:
        painter.draw({"a": Job(plot.custom, (line, thing), "")})
        handed = painter.jobs["a"].args[1]
        thing.more = 1
        assert handed is not thing
        assert not hasattr(handed, "more")
        assert painter.finish()["a"][0].startswith(b"\x89PNG")


def test_an_object_that_changes_while_it_is_packed_is_drawn_by_the_first_process(jobs, monkeypatch):
    def changing(*args, **options):
        raise RuntimeError("dictionary changed size during iteration")

    monkeypatch.setattr(drawing.pickle, "dump", changing)
    with Painter() as painter:
        painter.draw(jobs)
        drawn = painter.finish()
    assert all(png.startswith(b"\x89PNG") for png, _ in drawn.values())
