#!/usr/bin/python3
# ranks: 2
# Tests of the command line: all options and exit codes, the results directory and the files in it.
import pathlib
import re
import shutil
import subprocess

from harness import SOURCE, check, command, deck, main, run, start, summary

SMALL = """Tanktread:
  Membrane: {capillary number: 0.3}
  Surface: {elements per side: 3}
  Time: {final time: 0.05}
"""


def _stored_deck(results):
    import h5py

    with h5py.File(pathlib.Path(results) / "run.h5", "r") as file:
        return file["deck"][()].decode()


def version_and_help_are_printed():
    check(run("--version").stdout.startswith("tanktread "), "no version")
    text = run("--help").stdout
    check(text.startswith("Deformable capsules") and "Kokkos" not in text, f"not our help first:\n{text}")
    run("--kokkos-num-devices=1", "--version")
    for option in ("--set", "--output", "--overwrite", "--check", "--resume", "--reference", "--quiet", "deck"):
        check(option in text, f"{option} is not in the help")


def runs_at_the_same_time_do_not_disturb_one_another():
    for _ in range(15):
        for process in [start("--version") for _ in range(6)]:
            _, said = process.communicate(timeout=60)
            check(process.returncode == 0 and not said, process.returncode, said)


def check_prints_the_effective_deck_and_the_plan_and_writes_nothing():
    text = run(deck(SMALL), "--set", "Flow/viscosity=2", "--check").stdout
    check(text.startswith("Tanktread:\n") and "viscosity: 2.0" in text and "plan" in text, text)
    check(sorted(p.name for p in pathlib.Path().iterdir()) == ["deck.yaml"], "something was written")


def the_plan_names_given_forces_of_coupled_particles():
    for keys, given in ("motion: free, torque: [0, 0, 1]", True), ("motion: free", False):
        text = run(deck("Tanktread: {Flow: {type: quiescent}, Particle: {%s}, Output: {power balance: true}, Time: {final time: 1}}" % keys), "--check").stdout
        check(bool(re.search(r"\n  forces +as given\n", text)) == given, text)


def check_states_the_cost_of_a_velocity_unless_it_is_quiet():
    text = run(deck(SMALL), "--check").stdout
    cost = re.search(r"\n  evaluation +([\d.e+]+) kernel evaluations and ([\d.e-]+) s ", text)
    check(cost and float(cost[1]) > 0 and re.search(r"\n  memory +[\d]+ MB", text), text)
    check("kernel evaluations" not in run(deck(SMALL), "--check", "--quiet").stdout, "timed with --quiet")
    huge = run(deck(SMALL), "--set", "Surface/elements per side=60", "--set", "Particle/viscosity ratio=5", "--check").stdout
    check(re.search(r"\n  evaluation +not timed, .* would take about \d+ s", huge), huge)


def results_are_in_the_directory_named_after_the_deck():
    run(deck(SMALL, "small_capsule.yaml"), "--quiet")
    check(pathlib.Path("results/small_capsule/run.h5").is_file(), list(pathlib.Path().rglob("*")))


def later_decks_and_settings_override_earlier_ones_and_are_stored():
    base, over = deck(SMALL), deck("Tanktread:\n  Time: {final time: 0.04}\n  Flow: {viscosity: 3}\n", "overlay.yaml")
    run(base, over, "--set", "Flow/viscosity=2", "--set", "Membrane/pre-inflation=0.05", "--output", "out", "--quiet")
    text = _stored_deck("out")
    for line in ("final time: 0.04", "viscosity: 2.0", "pre-inflation: 0.05", "capillary number: 0.3", "elements per side: 3"):
        check(line in text, f"no '{line}' in:\n{text}")
    final = summary("out")["final"]
    check(final["time"] == 0.04, final["time"])


def the_exit_code_is_0_for_a_met_expectation_and_1_for_a_missed_one():
    met = ["--set", "Expect/volume/value=4.18879", "--set", "Expect/volume/tolerance=1.0e-2", "--output", "met", "--quiet"]
    run(deck(SMALL), *met)
    check(summary("met")["expect"][0]["passed"] is True, "not noted")
    missed = ["--set", "Expect/volume/value=5", "--set", "Expect/volume/tolerance=1.0e-2", "--output", "missed", "--quiet"]
    check("Expect" in run(deck(SMALL), *missed, code=1).stderr, "not said")
    check(summary("missed")["expect"][0]["passed"] is False, "not noted")


def a_missed_expectation_under_mpirun_prints_one_line():
    program = command(deck(SMALL), "--set", "Expect/volume/value=5", "--set", "Expect/volume/tolerance=1.0e-2", "--output", "out", "--quiet", ranks=2)
    quiet = ["mpirun", "-q", "--mca", "odls_base_sigkill_timeout", "0"]  # the launcher that --help recommends
    is_quiet = "(Open MPI) 4" in subprocess.run(["mpirun", "--version"], capture_output=True, text=True).stdout
    launcher = quiet if is_quiet else ["mpirun"]
    result = subprocess.run(launcher + program[1:], capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=600)
    check(result.returncode == 1 and result.stderr.startswith("tanktread: missed Expect/volume"), result.returncode, result.stderr)
    check(result.stderr.count("\n") == 1 or not is_quiet, result.stderr)
    check(result.stderr.count("tanktread:") == 1, result.stderr)
    check(" ".join(quiet) in " ".join(run("--help").stdout.split()), "not in the help")


def an_expectation_fails_a_run_only_with_the_keys_it_was_stated_for():
    base = deck(SMALL + "  Expect:\n    volume: {value: 5, tolerance: 1.0e-2}\n    early: {series: volume, value: 5, tolerance: 1.0e-2, at: 0.02}\n", "base.yaml")
    other = deck("Tanktread:\n  Flow: {viscosity: 2}\n", "other.yaml")
    stated = deck("Tanktread:\n  Flow: {viscosity: 2}\n  Expect:\n    volume: {tolerance: 2.0e-2}\n", "stated.yaml")
    same, longer = ["--set", "Surface/elements per side=3.0", "--set", "Output/interval=0.05"], ["--set", "Time/final time=0.06"]

    def missed(*arguments, code):
        result = run(*arguments, "--quiet", "--output", "out", code=code)
        shutil.rmtree("out")
        return [line for line in result.stderr.splitlines() if "does not fail the run" in line], result.stderr

    check(not missed(base, code=1)[0], "as shipped")
    check(not missed(base, *same, code=1)[0], "the same value, and the time between snapshots")
    for changed in ([other], ["--set", "Flow/viscosity=2"]):
        excused, said = missed(base, *changed, code=0)
        check(len(excused) == 2 and all("the deck was changed: Flow/viscosity" in line and "volume is 4.18" in line for line in excused), said)
    excused, said = missed(base, *longer, code=1)
    check(len(excused) == 1 and "Expect/volume:" in excused[0] and "Time/final time" in excused[0], said)
    excused, said = missed(base, stated, code=1)
    check(len(excused) == 1 and "Expect/early:" in excused[0] and "missed Expect/volume:" in said, said)
    check(len(missed(base, stated, "--set", "Flow/viscosity=3", code=0)[0]) == 2, "changed once more")
    check(len(missed(base, "--no-expect", code=0)[0]) == 2, "--no-expect")
    run(base, other, "--quiet", "--output", "out")
    check([one["not binding"] for one in summary("out")["expect"]] == 2 * ["the deck was changed: Flow/viscosity"], summary("out")["expect"])
    # the expectation does not bind the resumed run either
    run("--resume", "out", "--quiet", "--set", "Time/final time=0.06")
    # an expectation about the end of a run, which it has met, does not bind the longer run
    end = deck(SMALL + "  Expect: {end: {series: time, value: 0.05, tolerance: 1.0e-9}}\n", "end.yaml")
    run(end, "--set", "Time/final time=0.05", "--quiet", "--output", "met")
    run("--resume", "met", "--quiet", "--set", "Time/final time=0.06")


def an_expectation_compares_times_with_units():
    text = SMALL + "  Units: {}\n  Expect: {volume: {value: 5, tolerance: 1, at: %s}}\n"
    for at, end, binds in (("20 ms", "0.01 s", False), ("20 ms", "0.03 s", True), ("0.02", "30 ms", True), ("20 ms", "0.03", True)):
        said = run(deck(text % at), "--check", "--set", f"Time/final time={end}").stdout
        check(("not binding: \"\"" in said) == binds, at, end, said)


def an_expectation_after_the_end_of_the_run_is_missed_with_a_warning():
    late = ["--set", "Expect/volume/value=4.18879", "--set", "Expect/volume/tolerance=1", "--set", "Expect/volume/at=9", "--output", "late", "--quiet"]
    lines = run(deck(SMALL), *late, code=1).stderr.splitlines()
    check(len(lines) == 2 and "warning: Expect/volume will be missed: it is for the time 9" in lines[0] and "9" in lines[1], lines)
    check("Expect/volume will be missed" in run(deck(SMALL), *late, "--check").stderr, "not said by --check")


def a_failed_run_has_exit_code_3_one_line_and_a_checkpoint():
    hopeless = ["--set", "Time/minimum step=0.01", "--set", "Time/initial step=0.02", "--set", "Time/tolerance=1e-12", "--output", "out", "--quiet"]
    result = run(deck(SMALL), *hopeless, code=3)
    check(len(result.stderr.splitlines()) == 1, result.stderr)
    check(list(pathlib.Path("out").glob("snapshot_*.hdf")), "no checkpoint")


def a_resumed_run_may_change_its_end_but_not_its_mesh():
    run(deck(SMALL), "--output", "out", "--quiet")
    refused = run("--resume", "out", "--set", "Surface/elements per side=4", code=2).stderr
    check("Surface/elements per side" in refused and "it was 3" in refused and "now is 4" in refused, refused)
    run("--resume", "out", "--set", "Time/final time=0.07", "--quiet")
    check(summary("out")["final"]["time"] == 0.07, "not gone on")
    check("final time: 0.07" in _stored_deck("out"), "the stored deck is the old one")


def cite_names_the_publications_of_the_features_a_deck_uses():
    plain = run(deck(SMALL), "--cite").stdout
    check("Comput. Methods Appl. Mech. Engrg. 326" in plain and plain.startswith("program: tanktread "), plain)
    features = {"law Mooney-Rivlin": "Membrane/law=Mooney-Rivlin", "law Evans-Skalak": "Membrane/law=Evans-Skalak",
                "lattice": "Domain/side lengths=[6, 6, 6]", "surface viscosity": "Membrane/shear viscosity=0.1"}
    every = run("--cite").stdout
    for feature, setting in features.items():
        line = f"\n{feature}: "
        check(line not in plain and line in every, f"{feature} without being used")
        needed = {"law Mooney-Rivlin": "Membrane/neo-Hookean share=0.5", "surface viscosity": "Membrane/load measure=current"}
        extra = ["--set", needed[feature]] if feature in needed else []
        check(line in run(deck(SMALL), "--set", setting, *extra, "--cite").stdout, f"{feature} is not cited")
    check(not pathlib.Path("results").exists(), "--cite has run the deck")
    run(deck(SMALL), "--set", "Membrane/law=unknown", "--cite", code=2)


def the_version_is_the_same_everywhere():
    version = re.search(r"project\(tanktread VERSION (\S+)", (SOURCE / "CMakeLists.txt").read_text())[1]
    places = {"CITATION.cff": r"^version: (\S+)", "postproc/tanktread/__init__.py": r'^__version__ = "(.*)"', "CHANGELOG.md": r"^## (\d\S*)"}
    for name, pattern in places.items():
        found = re.search(pattern, (SOURCE / name).read_text(), re.MULTILINE)[1]
        check(found == version, f"{name} has version {found}, CMakeLists.txt {version}")


def xml_decks_are_read():
    text = '<ParameterList name="Tanktread"><ParameterList name="Flow"><Parameter name="viscosity" type="double" value="7"/></ParameterList>' \
           '<ParameterList name="Time"><Parameter name="final time" type="double" value="1"/></ParameterList></ParameterList>\n'
    check("viscosity: 7.0" in run(deck(text, "deck.xml"), "--check").stdout, "not read")


def the_manual_names_every_key_of_an_effective_deck():
    manual = run("--reference").stdout
    for line in run(SOURCE / "inputs/shear_paper.yaml", "--check").stdout.split("\nplan")[0].splitlines():
        key = line.strip().split(":")[0]
        if line.startswith("    ") and not line.startswith("      "):
            check(f"`{key}`" in manual or line.endswith(":"), f"{key} is not in the manual")


main()
