#!/usr/bin/python3
# ranks: 2
# Tests that a run which fails, is stopped or reaches its time limit leaves a checkpoint, and can be resumed with
# another scheme or tolerance.
import os
import pathlib
import signal
import subprocess
import time

from harness import check, command, deck, main, run, series, start, summary, wait_within

DECK = """
Tanktread:
  Flow: {type: simple shear}
  Membrane: {capillary number: 0.3}
  Surface: {elements per side: 3}
  Time: {final time: 0.5}
"""


def _goes_on(results, *settings):
    """Checks that the newest checkpoint can be read, that the resumed run reaches its end, and that no rows are
    missing."""
    begun = series(results, "time")
    words = [word for setting in settings for word in ("--set", setting)]
    run("--resume", results, *words, "--quiet")
    times = series(results, "time")
    check(times[-1] == 0.5, f"went on to {times[-1]} only")
    check((times[1:] > times[:-1]).all() and (times[:len(begun)] == begun).all(), "the record is not in order")
    check(abs(series(results, "volume_error")).max() < 1e-12, "volume lost")


def _fails(*settings):
    """Checks that the run exits with code 3 and one sentence with the reason, the time, and the path of the
    checkpoint."""
    words = [word for setting in settings for word in ("--set", setting)]
    said = run(deck(DECK), *words, "--output", "out", "--quiet", code=3).stderr
    check(len(said.splitlines()) == 1 and "at time" in said and "checkpoint" in said and "out" in said, said)
    check(list(pathlib.Path("out").glob("snapshot_*.hdf")), "no checkpoint")
    status = summary("out")["status"]
    check(status.startswith("failed: ") and status[8:] in said, status)
    return said


def a_run_with_too_small_steps_ends_and_continues_with_a_larger_tolerance():
    said = _fails("Time/minimum step=2e-3", "Time/tolerance=1e-9", "Time/initial step=0.01")
    check("minimum step" in said, said)
    _goes_on("out", "Time/tolerance=1e-4", "Time/minimum step=1e-9")


def a_run_whose_iteration_diverges_ends_and_continues_with_shorter_steps():
    said = _fails("Time/scheme=crank-nicolson", "Time/fixed step=0.5", "Output/interval=0.5")
    check("did not converge" in said, said)
    _goes_on("out", "Time/fixed step=0.02")


def a_stopped_run_has_a_checkpoint_and_continues():
    process = start(deck(DECK), "--set", "Time/tolerance=1e-9", "--set", "Time/final time=50", "--output", "out", "--quiet")
    end = time.monotonic() + 60
    while time.monotonic() < end and not (pathlib.Path("out/run.h5").exists() and len(series("out", "time")) > 3):
        time.sleep(0.02)
    process.send_signal(signal.SIGTERM)
    _, said = process.communicate(timeout=60)
    check(process.returncode == 4 and "signal" in said and "--resume out" in said, process.returncode, said)
    check(summary("out")["status"] == "stopped: by a signal", summary("out")["status"])
    check(summary("out")["final"]["time"] == series("out", "time")[-1], "the summary is not of the last step")


def a_run_stopped_within_a_long_step_continues_bitwise_equal():
    fine = ["--set", "Surface/elements per side=8", "--set", "Particle/viscosity ratio=5", "--set", "Time/final time=0.1"]
    run(deck(DECK), *fine, "--output", "whole", "--quiet")
    process = start(deck(DECK), *fine, "--output", "out", "--quiet")
    wait_within(process, "out", "whole")
    process.send_signal(signal.SIGHUP)
    _, said = process.communicate(timeout=60)
    check(process.returncode == 4 and "signal" in said, process.returncode, said)
    run("--resume", "out", "--quiet")
    check(summary("out")["status"] == "done", summary("out")["status"])
    for name in "time", "energy", "evaluations":
        check((series("out", name) == series("whole", name)).all(), f"{name} is not that of the run that was left alone")


def _told(signal_number, *arguments):
    """Starts the program and sends it a signal as soon as it has installed its signal handler. Returns exit code and
    standard error."""
    process = start(*arguments)
    end = time.monotonic() + 5
    while time.monotonic() < end and process.poll() is None:
        caught = [line.split()[1] for line in pathlib.Path(f"/proc/{process.pid}/status").read_text().splitlines() if line.startswith("SigCgt")]
        if caught and int(caught[0], 16) >> (signal_number - 1) & 1:
            break
        time.sleep(0.001)
    process.send_signal(signal_number)
    _, said = process.communicate(timeout=60)
    return process.returncode, said


def a_signal_before_the_first_step_ends_the_run_with_one_sentence():
    rigid = ["--set", "Particle/motion=prescribed", "--set", "Particle/velocity=[1, 0, 0]", "--set", "Flow/type=quiescent"]
    code, said = _told(signal.SIGTERM, deck("Tanktread:\n  Surface: {elements per side: 14}\n"), *rigid, "--output", "rigid", "--quiet")
    check(code == 4 and said == "tanktread: stopped by a signal before any results were written\n", code, said)
    code, said = _told(signal.SIGINT, deck(DECK), "--set", "Surface/elements per side=12", "--output", "out", "--quiet")
    check(code == 4 and said == "tanktread: stopped by a signal before any results were written\n", code, said)


def a_signal_before_the_first_step_of_a_resumed_run_says_that_it_continues():
    run(deck(DECK), "--set", "Time/final time=0.1", "--output", "out", "--quiet")
    times = series("out", "time")
    code, said = _told(signal.SIGTERM, "--resume", "out", "--set", "Time/final time=50", "--set", "Time/tolerance=1e-9", "--quiet")
    check(code == 4 and "--resume out continues the run" in said, code, said)
    check((series("out", "time")[:len(times)] == times).all(), "rows are lost")


def a_closed_standard_output_does_not_end_the_run():
    words = command(deck(DECK), "--output", "out")
    reader, writer = os.pipe()
    os.close(reader)
    code = subprocess.run(words, stdin=subprocess.DEVNULL, stdout=writer, stderr=writer, timeout=60).returncode
    os.close(writer)
    check(code == 0 and summary("out")["status"] == "done", f"exit code {code}")


def a_solver_that_fails_at_a_trial_shape_shortens_the_step():
    # an explicit scheme, because the stages of implicit schemes do not solve the linear system for the velocity
    short = ["Time/scheme=bs3", "Particle/viscosity ratio=5", "Solvers/Belos/Maximum Iterations=8", "Time/initial step=3", "Time/final time=3",
             "Output/interval=3"]
    said = _fails(*short)
    check("did not bring the velocity at viscosity ratio 5" in said, said)
    times = series("out", "time")
    check(times[-1] > 1, f"ended at {times[-1]}, though eight iterations are enough until 1.5")
    newest = sorted(pathlib.Path("out").glob("snapshot_*.hdf"))[-1].name
    check(newest == f"snapshot_{len(times) - 1:06d}.hdf", f"{newest} is not of the last of {len(times)} rows")


def only_one_run_at_a_time_may_write_to_a_directory():
    process = start(deck(DECK), "--set", "Time/tolerance=1e-9", "--set", "Time/final time=50", "--output", "out", "--quiet")
    while process.poll() is None and not (pathlib.Path("out/run.h5").exists() and len(series("out", "time")) > 3):
        time.sleep(0.02)
    for arguments in ([deck(DECK), "--output", "out"], ["--resume", "out"]):
        said = run(*arguments, "--quiet", code=2).stderr
        check("another run" in said and "out" in said, said)
    process.kill()
    process.communicate()
    run("--resume", "out", "--set", "Time/final time=0.5", "--set", "Time/tolerance=1e-4", "--quiet")


def exceeding_the_file_size_limit_is_a_write_error():
    words = " ".join(f"'{word}'" for word in command(deck(DECK), "--output", "out", "--quiet"))
    result = subprocess.run(["bash", "-c", f"ulimit -f 40; {words}"], capture_output=True, text=True, timeout=60)
    check(result.returncode == 3 and "cannot write" in result.stderr, result.returncode, result.stderr)


def a_run_stops_at_its_wall_clock_limit():
    said = run(deck(DECK), "--set", "Time/tolerance=1e-9", "--set", "Time/final time=50", "--set", "Output/wall-clock limit=0.5", "--output", "out",
               "--quiet", code=4).stderr
    check("wall-clock" in said, said)
    check(summary("out")["status"] == "stopped: at the wall-clock limit", summary("out")["status"])
    steps = len(series("out", "time"))
    run("--resume", "out", "--quiet", code=4)  # the time limit applies to each call separately
    check(len(series("out", "time")) > steps, "no step more")
    deck("Tanktread: {Flow: {type: simple shear}, Particle: {motion: prescribed}, Output: {wall-clock limit: 1.0e-6}}", "held.yaml")
    said = run("held.yaml", "--quiet", "--output", "held", code=4).stderr
    check(len(said.splitlines()) == 1 and "wall-clock limit" in said and not pathlib.Path("held").exists(), said)


def an_error_on_the_first_rank_ends_all_ranks():
    pathlib.Path("file").write_text("")
    said = run(deck(DECK), "--output", "file/out", "--quiet", ranks=2, code=2, timeout=60).stderr
    ours = [line for line in said.splitlines() if line.startswith("tanktread:")]
    check(len(ours) == 1 and "file/out cannot be used" in ours[0], said)
    pathlib.Path("out/run.h5.part").mkdir(parents=True)  # where the record is written first
    said = run(deck(DECK), "--output", "out", "--quiet", ranks=2, code=3, timeout=60).stderr
    check(sum(line.startswith("tanktread: cannot write") for line in said.splitlines()) == 1, said)


def a_checkpoint_of_another_version_is_rejected():
    import h5py

    run(deck(DECK), "--set", "Time/final time=0.1", "--output", "out", "--quiet")
    for snapshot in pathlib.Path("out").glob("snapshot_*.hdf"):
        with h5py.File(snapshot, "r+") as file:
            names = file["checkpoint/names of numbers"]
            names[()] = names[()].replace(b"tangents", b"tongents")
            del file["checkpoint"].attrs["checksum"]
    said = run("--resume", "out", "--quiet", code=2).stderr
    check("another version" in said, said)
    for name in "arrays/x shape 1", "arrays/phase and tank-treading frequency", "texts/deck":
        run(deck(DECK), "--set", "Time/final time=0.1", "--output", "out", "--quiet", "--overwrite")
        for snapshot in pathlib.Path("out").glob("snapshot_*.hdf"):
            with h5py.File(snapshot, "r+") as file:
                rows = file[f"checkpoint/{name}"][:-1] if name.startswith("arrays") else None
                del file["checkpoint"].attrs["checksum"], file[f"checkpoint/{name}"]
                if rows is not None:
                    file[f"checkpoint/{name}"] = rows
        said = run("--resume", "out", "--quiet", code=2).stderr
        check("another version" in said and len(said.splitlines()) == 1, said)


main()
