#!/usr/bin/env python3
"""Instructions a node of each composed field with its Jacobian beside one written by hand, counted by valgrind.

    field_instructions.py PROGRAM [-]     '-': the ideal systems alone
"""
import re
import subprocess
import sys

NODES = 256


def instructions(program, *arguments):
    run = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, *arguments],
                         capture_output=True, text=True, check=True)
    return int(re.search(r"Collected : (\d+)", run.stderr).group(1))


def a_node(program, *arguments):
    few, many = (instructions(program, *arguments, str(count)) for count in (10, 110))
    return (many - few) / 100 / NODES


program = sys.argv[1]
for name in ("double_pendulum", "pcr3bp", "swinging_spring", "duffing"):
    print(f"{name} ideal: {a_node(program, name, '-', 'system'):.2f}")
if sys.argv[2:] != ["-"]:
    for line in subprocess.run([program], capture_output=True, text=True, check=True).stdout.splitlines():
        name, effects = line.split()
        composed, hand = (a_node(program, name, effects, who) for who in ("system", "hand"))
        print(f"{name} {effects}: {composed:.2f}, by hand {hand:.2f}, {100 * (composed / hand - 1):+.1f} %")
