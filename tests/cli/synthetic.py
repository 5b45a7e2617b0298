#!/usr/bin/python3
# label: long
# Tests fits to profiles with noise: the moduli are unbiased, their scatter agrees with the stated errors, and the law
# of the data is never rejected.
import os
import re
import subprocess

from harness import PROGRAM, SOURCE, check, main

ROW = re.compile(r"\| (.+) \| ([\d.]+) % \| ([-+\d.]+) % ± ([\d.]+) % \| [\d.]+ % \| [\d.]+ % \| ([\d.]+) \| (\d+) of (\d+), wrongly (\d+) \|")


def moduli_from_noisy_profiles_scatter_by_their_stated_errors():
    result = subprocess.run([SOURCE / "tests/benchmark/synthetic_profiles.py", "--samples", "40"], capture_output=True, text=True,
                            env=os.environ | {"TANKTREAD": str(PROGRAM)})
    check(result.returncode == 0, result.stdout, result.stderr)
    for far in re.findall(r"the emulator is (\S+) of the radius", result.stdout):
        check(float(far) < 1e-4, f"the emulator is {far} of the radius from runs")  # 1/50 of the smaller noise
    rows = ROW.findall(result.stdout)
    check(len(rows) == 4, result.stdout)
    for law, noise, bias, error, ratio, told, number, wrong in rows:
        check(abs(float(bias)) < 3.5 * float(error), law, noise, "bias", bias, error)
        # the standard deviation of 40 samples is uncertain by 11 %; the bounds allow for three times this uncertainty
        check(0.65 < float(ratio) < 1.4, law, noise, "spread over stated", ratio)
        check(int(wrong) == 0, law, noise, "another law is preferred", wrong)
    check(int(rows[0][5]) > 0.6 * int(rows[0][6]), "the law is not told at the smaller noise", rows[0])


main()
