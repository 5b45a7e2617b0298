#!/usr/bin/python3
# ranks: 2
# Tests that a killed and resumed run is bitwise equal to an uninterrupted run.
import pathlib
import random
import re
import shutil
import signal
import time

import numpy

from harness import check, deck, main, run, series, start, summary, wait_within

DECK = """
Tanktread:
  Flow: { type: simple shear }
  Particle: { shape: sphere }
  Membrane: { law: neo-Hookean, capillary number: 0.3 }
  Surface: { mesh: cube, elements per side: 3 }
  Time: { final time: 8.0, tolerance: 1.0e-5 }
  Output: { interval: 0.25 }
"""
OWN_TIME = ["wall_seconds"]  # the only series that may differ


def _names(results):
    """Returns the names of all series of a run."""
    import h5py

    names = []
    with h5py.File(pathlib.Path(results) / "run.h5", "r") as file:
        file["series"].visititems(lambda name, one: names.append(name) if isinstance(one, h5py.Dataset) else None)
    return names


def _same_bits(one, other):
    """Checks that two runs are bitwise equal in all series and in their last checkpoint."""
    check(_names(one) == _names(other), "the series have other names")
    for name in _names(one):
        if name not in OWN_TIME:
            a, b = series(one, name), series(other, name)
            check(a.shape == b.shape, f"{name}: {len(a)} rows and {len(b)}")
            check(a.tobytes() == b.tobytes(), f"{name} differs by up to {numpy.nanmax(abs(a - b)):.3g}")
    a, b = _last_checkpoint(one), _last_checkpoint(other)
    check(a.keys() == b.keys(), "the last checkpoints hold different things")
    for name in a:
        check(a[name].tobytes() == b[name].tobytes(), f"{name} of the last checkpoint differs")


def _last_checkpoint(results):
    """Returns {name: array or number} of the checkpoint in the newest snapshot."""
    import h5py

    with h5py.File(sorted(pathlib.Path(results).glob("snapshot_*.hdf"))[-1], "r") as file:
        root = file["checkpoint"]
        found = {f"arrays/{name}": data[()] for name, data in root["arrays"].items()}
        names = root["names of numbers"][()].decode().splitlines()
        found.update({f"numbers/{name}": number for name, number in zip(names, root["numbers"][()]) if "wall" not in name})
        return found


def _kill_after(results, snapshots, *arguments):
    """Starts a run and kills it when it has written `snapshots` snapshots."""
    _kill_when(lambda: len(list(pathlib.Path(results).glob("snapshot_*.hdf"))) >= snapshots, *arguments)


def _kill_when(holds, *arguments):
    """Starts a run and kills it as soon as holds() is true."""
    process = start(*arguments)
    end = time.monotonic() + 300
    while process.poll() is None and time.monotonic() < end:
        if holds():
            break
        time.sleep(0.001)
    process.send_signal(signal.SIGKILL)
    said = process.communicate()
    check(process.returncode == -signal.SIGKILL, f"the run ended before it was to be killed: {said}")


def a_killed_run_is_resumed_bitwise_equal_with_every_scheme():
    for scheme in "auto", "tr-bdf2", "bdf3", "bs3", "rkc2", "crank-nicolson":
        text = DECK.replace("Time: {", f"Time: {{ scheme: {scheme},")
        deck(text.replace("interval: 0.25", "interval: 0.2"))
        run("deck.yaml", "--output", f"whole_{scheme}", "--quiet")
        _kill_after(f"killed_{scheme}", 5, "deck.yaml", "--output", f"killed_{scheme}", "--quiet")
        run("--resume", f"killed_{scheme}", "--quiet")
        _same_bits(f"whole_{scheme}", f"killed_{scheme}")


def a_run_that_is_killed_repeatedly_has_the_same_end():
    deck(DECK)
    begin = time.monotonic()
    run("deck.yaml", "--output", "whole", "--quiet")
    duration = time.monotonic() - begin
    moments = random.Random(6)
    _kill_after("killed", 3, "deck.yaml", "--output", "killed", "--quiet")
    for _ in range(6):
        process = start("--resume", "killed", "--quiet")
        time.sleep(moments.uniform(0.1, 0.7) * duration)
        process.send_signal(signal.SIGKILL)
        process.communicate()
    run("--resume", "killed", "--quiet")
    _same_bits("whole", "killed")


def the_checkpoint_contains_initial_guesses_of_solvers():
    """Tests scenes whose solutions depend on earlier solves, which give the initial guess or the recycled subspace: a
    free body in a tube, and a capsule with the preconditioner `recycled`. Snapshots are written between two steps."""
    body = "Particle: {motion: free, radius: 0.5, center: [0, 0.2, 0.1]}\n  Surface: {elements per side: 3}"
    capsule = ("Particle: {radius: 0.5, viscosity ratio: 5}\n  Membrane: {law: neo-Hookean, shear modulus: 5}\n  Surface: {elements per side: 3}\n"
               "  Solvers: {velocity: {preconditioner: recycled}}")
    for name, particle in ("body", body), ("capsule", capsule):
        deck(f"""
Tanktread:
  Flow: {{type: duct}}
  Tube: {{section: circle, azimuthal elements: 8, axial elements: 8}}
  {particle}
  Time: {{scheme: bs3, fixed step: 0.01, final time: 1.5}}
  Output: {{interval: 0.125}}
""", f"{name}.yaml")
        run(f"{name}.yaml", "--output", f"whole_{name}", "--quiet")
        snapshots = pathlib.Path(f"killed_{name}")
        _kill_when(lambda: len(list(snapshots.glob("snapshot_*.hdf"))) >= 4, f"{name}.yaml", "--output", snapshots, "--quiet")
        check(len(list(snapshots.glob("snapshot_*.hdf"))) < 13, f"{name} was killed too late")
        run("--resume", snapshots, "--quiet")
        _same_bits(f"whole_{name}", snapshots)


def a_run_resumed_on_other_ranks_agrees_to_1e_10():
    deck(DECK)
    run("deck.yaml", "--output", "whole", "--quiet")
    _kill_after("killed", 6, "deck.yaml", "--output", "killed", "--quiet")
    run("--resume", "killed", "--quiet", ranks=2)
    for name in "time", "taylor_inertia", "area", "energy":
        a, b = series("whole", name), series("killed", name)
        check(a.shape == b.shape, f"{name}: {len(a)} rows and {len(b)}")
        worst = abs(a - b).max()
        check(worst <= 1e-10, f"{name} differs by {worst:.3g}")


def sigterm_ends_the_run_with_a_checkpoint_of_the_last_step():
    deck(DECK)
    run("deck.yaml", "--output", "whole", "--quiet")
    process = start("deck.yaml", "--output", "stopped", "--quiet")
    wait_within(process, "stopped", "whole")
    process.send_signal(signal.SIGTERM)
    _, said = process.communicate(timeout=60)
    check("Traceback" not in said and "signal" in said, said)
    rows = len(series("stopped", "time"))
    check(rows < len(series("whole", "time")), "the run was over before it was told to stop")
    check(pathlib.Path(f"stopped/snapshot_{rows - 1:06d}.hdf").exists(), "no checkpoint of the last step")
    run("--resume", "stopped", "--quiet")
    _same_bits("whole", "stopped")


def warnings_and_counters_include_all_parts_of_a_resumed_run():
    strong = ["--set", "Membrane/load=strong", "--set", "Time/final time=0.5"]
    said = run(deck(DECK), *strong, "--output", "whole", "--quiet").stderr
    check("strong form" in said, "nothing to warn of", said)
    run("deck.yaml", *strong, "--set", "Time/final time=0.25", "--output", "parts", "--quiet")
    said = run("--resume", "parts", "--set", "Time/final time=0.5", "--quiet").stderr
    check("strong form" not in said, "said again", said)
    whole, parts = summary("whole"), summary("parts")
    check(parts["warnings"] == whole["warnings"], parts["warnings"])
    check(parts["counts"] == whole["counts"], parts["counts"], whole["counts"])


def a_run_resumed_from_any_checkpoint_has_the_counts_of_the_whole_run():
    """The velocity of the first step's shape is evaluated twice by the scheme `auto`; snapshots of rigid bodies need an
    evaluation; the set-up of a tube counts evaluations of kernels; `recycled` keeps products of earlier solves."""
    drop = ("Membrane: {law: surface tension, surface tension: 2.0}\n  Particle: {viscosity ratio: 0.5}\n  Surface: {elements per side: 3}\n"
            "  Time: {final time: 0.06, scheme: auto}\n  Output: {interval: 0.02}\n")
    bodies = ("Particles: {a: {motion: free, Surface: {elements per side: 3}}, b: {motion: free, center: [0, 0, 2.6], Surface: {elements per side: 3}}}\n"
              "  Time: {final time: 0.2}\n  Output: {interval: 0.05}\n")
    tube = ("Tube: {section: circle, azimuthal elements: 8, axial elements: 8}\n  Flow: {type: duct}\n  Surface: {elements per side: 3}\n"
            "  Particle: {radius: 0.5, center: [0, 0.2, 0.1], viscosity ratio: 5}\n  Membrane: {shear modulus: 5}\n  Time: {final time: 0.04}\n"
            "  Output: {interval: 0.02}\n")
    for name, text in {"drop": drop, "recycled": drop + "  Solvers: {velocity: {preconditioner: recycled}}\n", "bodies": bodies, "tube": tube}.items():
        run(deck("Tanktread:\n  " + text, f"{name}.yaml"), "--output", name, "--quiet")
        snapshots = sorted(path.name for path in pathlib.Path(name).glob("snapshot_*.hdf"))
        for k in 0, len(snapshots) - 2:
            parts = pathlib.Path(f"{name}_{k}")
            shutil.copytree(name, parts)
            for later in snapshots[k + 1:]:
                (parts / later).unlink()
            run("--resume", parts, "--quiet")
            _same_bits(name, parts)
            check(summary(parts)["counts"] == summary(name)["counts"], name, k, summary(parts)["counts"], summary(name)["counts"])


def holding_the_centroid_does_not_shorten_steps():
    held = ["--set", "Particle/drift=held", "--set", "Particle/center=[0, 0, 1]", "--set", "Time/final time=1", "--set", "Time/tolerance=1e-4"]
    steps = {}
    for name, more in ("held", held), ("centred", held[4:]):
        run(deck(DECK), *more, "--set", "Time/scheme=bdf3", "--set", "Output/interval=1", "--output", name, "--quiet")
        steps[name] = len(series(name, "time"))
    check(steps["held"] <= 1.2 * steps["centred"], steps)


def a_damaged_newest_checkpoint_is_skipped():
    deck(DECK)
    run("deck.yaml", "--output", "whole", "--quiet")
    run("deck.yaml", "--output", "damaged", "--quiet")
    newest = sorted(pathlib.Path("damaged").glob("snapshot_*.hdf"))[-1]
    newest.write_bytes(newest.read_bytes()[:2000])
    said = run("--resume", "damaged", "--quiet").stderr
    check(f"{newest.name} is damaged (" in said and "the run continues from snapshot_" in said, said)
    check(newest.with_name(newest.name + ".damaged").stat().st_size == 2000, "the damaged file is lost")
    _same_bits("whole", "damaged")


def another_scheme_continues_from_the_shape():
    end = "Time/final time=0.6"
    run(deck(DECK), "--set", end, "--output", "whole", "--quiet")
    d = series("whole", "taylor_inertia")[-1]
    crank = ["--set", "Time/step control=error", "--set", "Time/nonlinear solver=anderson"]
    for one, other, more in ("tr-bdf2", "auto", []), ("auto", "bdf3", []), ("bdf3", "auto", []), ("tr-bdf2", "crank-nicolson", crank), ("rkc2", "auto", []):
        name = f"{one}_{other}"
        run("deck.yaml", "--set", "Time/final time=0.3", "--set", f"Time/scheme={one}", "--output", name, "--quiet")
        run("--resume", name, "--set", end, "--set", f"Time/scheme={other}", *more, "--quiet")
        check(abs(series(name, "taylor_inertia")[-1] - d) < 2e-4, f"{name}: another D than {d}")  # steps of 1e-5


def the_final_time_may_change_and_the_membrane_may_not():
    deck(DECK)
    run("deck.yaml", "--output", "short", "--set", "Time/final time=0.5", "--quiet")
    run("--resume", "short", "--set", "Time/final time=1.0", "--quiet")
    check(series("short", "time")[-1] == 1.0, "the run did not go on to its new end")
    result = run("--resume", "short", "--set", "Time/final time=0.75", "--quiet")
    check("Time/final time 0.75 is before the time 1 " in result.stderr, result.stderr)
    result = run("--resume", "short", "--set", "Membrane/capillary number=0.6", code=2)
    check("Membrane/capillary number" in result.stderr, result.stderr)


def keys_that_series_depend_on_may_not_change():
    deck(DECK)
    for setting in "Output/power balance=true", "Output/view direction=[0, 1, 0]", "Contact/limiter=true":
        more = ["--set", "Contact/limit=0.01"] if "Contact" in setting else []
        lattice = ["--set", "Domain/periodic=x1 x2 x3", "--set", "Domain/side lengths=[5, 5, 5]"] if more else []
        run("deck.yaml", *lattice, "--output", "short", "--overwrite", "--set", "Time/final time=0.1", "--set", "Output/interval=0.1", "--quiet")
        result = run("--resume", "short", "--set", "Time/final time=0.2", "--set", setting, *more, code=2)
        check(f"{setting.split('=')[0]} cannot change when a run continues" in result.stderr, result.stderr)
    # Each new key of Output must be added here, and to `fixed` in may_change_on_resume() if checkpoints or files that grow with the run depend on it.
    free, fixed = {"interval": 0.05, "between steps": "land", "wall-clock limit": 1000, "surface text": "true"}, {"power balance", "view direction"}
    keys = set(re.findall(r"^\| `([^`]+)` \|", run("--reference").stdout.split("\n## Output\n")[1].split("\n## ")[0], re.MULTILINE))
    check(keys == fixed | set(free), keys)
    for key, value in free.items():
        run("--resume", "short", "--check", "--quiet", "--set", f"Output/{key}={value}")


def a_directory_without_a_checkpoint_is_a_mistake():
    pathlib.Path("empty").mkdir()
    for directory in "empty", "absent":
        result = run("--resume", directory, code=2)
        check(directory in result.stderr and result.stderr.count("\n") == 1, result.stderr)


main()
