"""Signals end `sap` with their exit status, and leave either the whole output or none of it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

SAP = [sys.executable, "-m", "sweep_and_prune"]
POINTS = str(Path(__file__).with_name("signal_points.py"))
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals there")


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


OUTPUT = ["sweep_and_prune/_output.py", "sweep_and_prune/_signals.py"]
"""Where files are made and removed."""
PACKAGE = ["sweep_and_prune/", "contextlib.py"]


@pytest.mark.parametrize(
    ("name", "ignored"), [("SIGINT", None), ("SIGTERM", None), ("SIGHUP", None), ("SIGTERM", "SIGHUP")]
)
@pytest.mark.parametrize("second", [0, 1, 15])
def test_a_signal_at_any_instruction_leaves_no_file_that_is_not_complete(
    name: str, ignored: str | None, second: int
) -> None:
    def ignore() -> None:  # as nohup does
        if ignored is not None:
            signal.signal(getattr(signal, ignored), signal.SIG_IGN)

    is_long = "TEST_LONG" in os.environ
    for places, stride, least in (
        (OUTPUT, 1 if is_long or name == "SIGINT" else 7, 200),
        (PACKAGE, 1 if is_long else 101, 3000),
    ):
        command = [sys.executable, POINTS, name, str(stride), str(second), *places]
        done = subprocess.run(command, capture_output=True, text=True, check=True, preexec_fn=ignore)
        points, *wrong = done.stdout.splitlines()
        assert wrong == []
        assert int(points) > least / stride


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_a_program_that_writes(number: signal.Signals) -> None:
    np.save("a.npy", np.zeros((30_000, 2)))  # 450 million pairs
    program = subprocess.Popen(
        [*SAP, "pairs", "a.npy", "-o", "p.csv"],
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(number, signal.SIG_DFL),
    )
    while not list(Path().glob(".sap-*.part")):
        assert program.poll() is None
    program.send_signal(number)
    _, said = program.communicate(timeout=600)
    assert (program.returncode, said.strip()) == (128 + number, "sap: cancelled")
    assert os.listdir() == ["a.npy"]


def test_a_signal_that_is_ignored_stays_so() -> None:
    np.save("a.npy", [[0.0, 1.0]])
    os.mkfifo("pipe.csv")
    program = subprocess.Popen(
        [*SAP, "pairs", "a.npy", "-o", "pipe.csv"], preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN)
    )
    with open("pipe.csv") as pipe:  # opens when the program does
        program.send_signal(signal.SIGHUP)
        assert pipe.read() == "a,b\n"
    assert program.wait(600) == 0
