"""Reads the options of troffer from the program itself (`troffer help --json`)."""
import json
import subprocess


def read(program):
    text = subprocess.run([program, 'help', '--json'], check=True, capture_output=True,
                          text=True).stdout
    return json.loads(text)


def options(command):
    """Returns all options of a command, positionals included."""
    return [o for group in command['groups'] for o in group['options']]


def long_names(option):
    return [n for n in option['names'] if n.startswith('--')]

