#!/usr/bin/env python3
"""Makes manual pages and shell completion from the program's help.

manual.py TROFFER VERSION FOLDER: writes troffer.1, troffer-COMMAND.1, troffer.bash, _troffer (zsh)
and troffer.fish to FOLDER.
"""
import pathlib
import sys

sys.dont_write_bytecode = True  # the source folder stays unchanged

import completion
import program_help


def roff(text):
    text = text.replace('\\', '\\e').replace('-', '\\-')
    return '\\&' + text if text[:1] in '.\'' else text


def term(option):
    names = ', '.join(option['names'])
    return f"\\fB{roff(names)}\\fR {roff(option['value'])}".rstrip()


def page(name, version, summary, synopsis, body, others):
    """body: {heading: [(term, description)]}."""
    out = [f'.TH {name.upper()} 1 "" "troffer {version}" "User Commands"', '.SH NAME',
           f'{roff(name)} \\- {roff(summary)}', '.SH SYNOPSIS', f'.B {roff(synopsis)}']
    for heading, rows in body.items():
        out.append(f'.SH {heading.upper()}')
        for what, description in rows:
            out += ['.TP', what, roff(description)]
    out += ['.SH EXIT STATUS', '0: done; 1: a file that cannot be used, or the machine fails; '
            '2: a wrong command line; 130: interrupted, what was finished is written.']
    if others:
        out += ['.SH SEE ALSO', ', '.join(f'\\fB{roff(o)}\\fR(1)' for o in others)]
    return '\n'.join(out) + '\n'


def main():
    program, version, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    help_ = program_help.read(program)
    others = [f"troffer-{c['name']}" for c in help_['commands']]
    for command in help_['commands']:
        name = f"troffer-{command['name']}"
        body = {group['name']: [(term(o), o['full_text']) for o in group['options']]
                for group in command['groups']}
        (folder / f'{name}.1').write_text(
            page(name, version, command['summary'], command['usage'], body,
                 ['troffer'] + [o for o in others if o != name]), encoding='utf-8')
    for file, make in (('troffer.bash', completion.bash), ('_troffer', completion.zsh),
                       ('troffer.fish', completion.fish)):
        (folder / file).write_text(make(help_), encoding='utf-8')
    commands = {'Commands': [(f"\\fB{c['name']}\\fR", c['summary']) for c in help_['commands']]}
    # Written last, because the build takes this file as a sign that all are complete.
    (folder / 'troffer.1').write_text(
        page('troffer', version, help_['summary'], 'troffer COMMAND [OPTIONS]', commands, others),
        encoding='utf-8')


if __name__ == '__main__':
    main()
