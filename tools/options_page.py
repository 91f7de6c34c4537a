#!/usr/bin/env python3
"""Makes docs/reference/options.md from the program's help.

options_page.py TROFFER FILE: writes the page.
options_page.py --check TROFFER FILE: fails if the page is out of date.
"""
import pathlib
import sys

sys.dont_write_bytecode = True  # the source folder stays unchanged

import program_help


def cell(text):
    return text.replace('|', '\\|')


def values(option):
    """Returns what the option takes: its choices, its range or its files."""
    if option['choices']:
        return ', '.join(f'`{c}`' for c in option['choices'])
    if option['range']:
        return option['range']
    if option['files'] == ['/']:
        return 'a folder'
    if option['files'] and option['files'] != ['*']:
        return ' '.join(f'`.{e}`' for e in option['files'])
    return ''


def row(option):
    names = ', '.join(f'`{n}`' for n in option['names'])
    value = f" `{option['value']}`" if option['value'] else ''
    notes = [n for n, is_so in (('required', option['is_required']),
                                ('may be repeated', option['is_repeatable'])) if is_so]
    text = option['text']
    for note in notes:
        if note not in text:
            text += f' ({note})'
    return (f"| {cell(names + value)} | {cell(text)} | {cell(values(option))} | "
            f"{cell(option['default'])} |")


def page(help_):
    out = ['# Options', '',
           'Every command and option, as the program lists them. `tools/options_page.py` writes this',
           'page; a test compares the two. [usage.md](usage.md) explains what the commands do.',
           '']
    out += [f"- [{c['name']}](#troffer-{c['name']}): {c['summary']}" for c in help_['commands']]
    for command in help_['commands']:
        out += ['', f"## troffer {command['name']}", '', f"    {command['usage']}", '',
                command['summary'] + '.']
        for group in command['groups']:
            out += ['', f"### {group['name']}", '', '| option | meaning | values | default |',
                    '|---|---|---|---|']
            out += [row(o) for o in group['options']]
    return '\n'.join(out) + '\n'


def main():
    is_check = sys.argv[1] == '--check'
    program, file = sys.argv[1 + is_check:]
    text, path = page(program_help.read(program)), pathlib.Path(file)
    if not is_check:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding='utf-8')
    elif not path.exists() or path.read_text(encoding='utf-8') != text:
        sys.exit(f'{file} is not current: run tools/options_page.py TROFFER {file}')


if __name__ == '__main__':
    main()
