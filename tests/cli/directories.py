#!/usr/bin/python3
# ranks: 1
# Tests that results are not lost, neither to another run in the same directory nor to a read error, that changed files
# or files of another run are rejected, and that write errors are reported.
import pathlib
import shutil

import h5py

from harness import check, deck, main, run, series

DECK = """
Tanktread:
  Flow: {type: simple shear}
  Membrane: {capillary number: 0.3}
  Surface: {elements per side: 3}
  Time: {final time: 0.1}
  Output: {interval: 0.05}
"""


def _refused(directory, *words):
    said = run("--resume", directory, "--quiet", code=2).stderr
    check(all(word in said for word in words) and said.count("\n") == 1, said)


def a_finished_run_is_deleted_only_when_asked():
    run(deck(DECK), "--output", "out", "--quiet")
    whole = pathlib.Path("out/run.h5").read_bytes()
    said = run("deck.yaml", "--output", "out", "--quiet", code=2).stderr
    check("--resume" in said and "--overwrite" in said and said.count("\n") == 1, said)
    check(pathlib.Path("out/run.h5").read_bytes() == whole, "the record is another")
    run("deck.yaml", "--output", "out", "--overwrite", "--set", "Time/final time=0.05", "--quiet")
    check(series("out", "time")[-1] == 0.05, "the old run is still there")
    run("deck.yaml", "--output", "out", "--check")
    check("contradict" in run("--resume", "out", "--overwrite", code=2).stderr, "--overwrite and --resume")
    pathlib.Path("notes").mkdir()
    pathlib.Path("notes/notes.txt").write_text("mine")
    run("deck.yaml", "--output", "notes", "--quiet")
    check(pathlib.Path("notes/notes.txt").read_text() == "mine", "a file that is no result is gone")
    run("deck.yaml", "--output", "sweep/level_1", "--quiet")
    run("deck.yaml", "--output", "sweep", "--quiet")
    check(pathlib.Path("sweep/level_1/run.h5").exists(), "results in a folder are gone that no requested accuracy has made")


def runs_with_changed_keys_have_directories_named_after_the_keys():
    deck(DECK)
    deck("Tanktread: {Time: {final time: 0.05}}", "over lay.yaml")
    for ca in "0.2", "0.3":
        run("deck.yaml", "over lay.yaml", "--set", f"Membrane/capillary number={ca}", "--quiet")
    run("deck.yaml", "--set", "Time/final time=0.05", "--quiet")
    run("deck.yaml", "--set", "Time/final time=0.05", *["--set", "Time/tolerance=1e-3"] * 20, "--quiet")
    found = {path.name for path in pathlib.Path("results").iterdir()}
    check({"deck_over_lay_capillary_number=0.2", "deck_over_lay_capillary_number=0.3", "deck_final_time=0.05"} < found and len(found) == 4, found)
    check(max(map(len, found)) == 100, found)


def a_file_that_cannot_be_read_ends_the_run_and_nothing_is_removed():
    run(deck(DECK), "--output", "out", "--quiet")
    before = sorted(path.name for path in pathlib.Path("out").iterdir())
    newest = sorted(pathlib.Path("out").glob("snapshot_*.hdf"))[-1]
    newest.rename("kept")
    newest.symlink_to("/proc/self/mem")  # can be opened, but reading it is an input error
    said = run("--resume", "out", "--quiet", code=3).stderr
    check(f"cannot read out/{newest.name}: Input/output error" in said, said)
    check(newest.is_symlink() and before == sorted(path.name for path in pathlib.Path("out").iterdir()), "a file is gone")


def changed_files_and_files_of_another_run_are_rejected():
    deck(DECK)
    for name in "out", "other":
        run("deck.yaml", "--output", name, "--quiet")
    shutil.copytree("out", "flipped")
    shutil.copy("other/run.h5", "out/run.h5")
    _refused("out", "run.h5", "different runs")
    newest = sorted(pathlib.Path("flipped").glob("snapshot_*.hdf"))[-1]
    shutil.copy(newest, newest.with_name("snapshot_000099.hdf"))
    _refused("flipped", "snapshot_000099.hdf", "states another step")
    newest.with_name("snapshot_000099.hdf").unlink()
    with h5py.File("flipped/run.h5", "r+") as file:
        file["series/energy"][1] *= 1 + 1e-15
    _refused("flipped", "run.h5", "differ from what was written")


def the_advice_for_what_an_interrupted_run_leaves_works():
    """Each kind of directory that an interrupted run can leave is made from a complete one. A new run names the way
    that works: --resume if and only if it continues the run."""
    run(deck(DECK), "--output", "whole", "--quiet")
    search = deck("Tanktread: {Membrane: {law: surface tension}, Surface: {elements per side: 3}, Spectrum: {number: 1}}", "search.yaml")
    run(search, "--output", "search", "--quiet")

    def cut(path):
        path.write_bytes(path.read_bytes()[:-1000])

    def leave(*kept):
        return lambda files: [path.unlink() for path in files if not path.name.startswith(kept)]

    def snapshots(files):
        return [path for path in files if path.name.startswith("snapshot_")]

    kinds = {"whole": leave(""), "nothing": leave("none"), "record": leave("run.h5"), "snapshots": leave("snapshot_"), "summary": leave("summary"),
             "no checkpoint": leave("run", "summary"), "no list": leave("run.h5", "snapshot_"),
             "newest cut": lambda files: cut(snapshots(files)[-1]), "all cut": lambda files: [cut(one) for one in snapshots(files)],
             "record cut": lambda files: cut(pathlib.Path("out/run.h5")), "search": leave("")}
    continued = set()
    for kind, spoil in kinds.items():
        for option in "--output", "--resume":
            shutil.rmtree("out", ignore_errors=True)
            shutil.copytree("search" if kind == "search" else "whole", "out")
            spoil(sorted(pathlib.Path("out").iterdir()))
            if option == "--output":
                said = run("deck.yaml", "--output", "out", "--quiet", code=0 if kind == "nothing" else 2).stderr
                check("--overwrite deletes" in said or kind == "nothing", kind, said)
                advised = "--resume out continues it" in said
        result = run("--resume", "out", "--quiet", code=0 if advised else 2)
        check(advised or "run the deck again with --output out --overwrite" in result.stderr or kind == "search", kind, result.stderr)
        continued |= {kind} if advised else set()
    run("deck.yaml", "--output", "out", "--overwrite", "--quiet")
    check(continued == {"whole", "no list", "newest cut"}, continued)


def a_failed_write_to_standard_output_is_an_error():
    import subprocess

    from harness import command

    request = ["--accuracy", "taylor_inertia=50%"]
    for words in ([deck(DECK), "--check"], [deck(DECK), "--check", *request], [deck(DECK), "--cite"], ["--cite"], ["--help"], ["--version"],
                  ["--reference"], ["--reference-series"], ["--rejections"], ["--schema"], ["--new", "drop"]):
        with open("/dev/full", "w") as full:
            result = subprocess.run(command(*words), stdout=full, stderr=subprocess.PIPE, text=True, timeout=60)
        check(result.returncode == 3 and "cannot write to standard output" in result.stderr, words, result)


main()
