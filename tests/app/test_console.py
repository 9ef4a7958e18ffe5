"""Progress where nobody watches: long stages leave a line in the log, short ones do not."""

import pytest

from ogilvie.app import console


@pytest.mark.parametrize(("seconds", "said"), [(12.2, "coefficients: 40 frequencies (12 s)\n"), (0.5, "")])
def test_long_stages_are_told_in_a_log(seconds, said, capsys, monkeypatch):
    clock = iter([100.0, 100.0 + seconds])
    monkeypatch.setattr(console.time, "perf_counter", lambda: next(clock))
    with console.step("coefficients") as tell:
        tell("40 frequencies")
    assert capsys.readouterr() == ("", said)
