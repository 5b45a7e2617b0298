#!/usr/bin/python3
# What cmake --install puts in place: a program, scripts that find it, a manual page, completion, and a library that another project links.
import os
import pathlib
import subprocess

from harness import PROGRAM, SOURCE, check, main


def _done(*words, **more):
    result = subprocess.run([str(word) for word in words], capture_output=True, text=True, **more)
    check(result.returncode == 0, words, result.stdout, result.stderr)
    return result.stdout


def _installed():
    place = pathlib.Path("place").resolve()
    _done("cmake", "--install", PROGRAM.parents[1], "--prefix", place)
    return place, os.environ | {"PATH": f"{place / 'bin'}:{os.environ['PATH']}", "TANKTREAD": ""}


def a_scene_is_run_and_shown_by_what_is_installed():
    place, environment = _installed()
    pathlib.Path("mine.yaml").write_text(_done("tanktread", "--new", "capsule", env=environment))
    _done("tanktread", "mine.yaml", "--set", "Surface/elements per side=3", "--set", "Time/final time=0.2", "--output", "mine", "--quiet", env=environment)
    _done("tanktread-report", "mine", env=environment)
    pathlib.Path("study.yaml").write_text("deck: mine.yaml\nset: {Surface/elements per side: 3, Time/final time: 0.1}\n"
                                          "grid: {Membrane/capillary number: [0.1, 0.2]}\nrecord: [taylor_inertia]\n")
    _done("tanktread-sweep", "study.yaml", env=environment)
    check(pathlib.Path("mine/report.html").exists() and pathlib.Path("results/study/table.csv").read_text().count(",done,") == 2, "report or table")
    page = (place / "share/man/man1/tanktread.1").read_text()
    check(".SH NAME" in page and "\\-\\-resume" in page, page[:500])


def options_keys_and_words_are_completed():
    place, environment = _installed()
    script = """source %s; complete() { :; }; COMP_WORDS=(%s); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); COMP_LINE=%s; COMP_POINT=${#COMP_LINE}
        compopt() { :; }; _tanktread; printf '%%s\\n' "${COMPREPLY[@]}" """
    completion = place / "share/bash-completion/completions/tanktread"

    def completed(line):
        words = " ".join(f"'{word}'" for word in line.split(" "))
        return _done("bash", "-c", script % (completion, words, f"'{line}'"), env=environment).split("\n")

    check("--resume" in completed("tanktread --res"), completed("tanktread --res"))
    check("Membrane/law=neo-Hookean" in completed("tanktread --set Membrane/l"), completed("tanktread --set Membrane/l"))
    check("red-cell" in completed("tanktread --new r"), completed("tanktread --new r"))


def another_project_links_the_library():
    place, _ = _installed()
    _done("cmake", "-S", SOURCE / "tests/package", "-B", "build", f"-DCMAKE_PREFIX_PATH={place}")
    _done("cmake", "--build", "build")
    check(abs(float(_done("build/sphere")) - 1) < 1e-4, "volume of a sphere")


main()
