#!/usr/bin/env python3
"""Manual pages and bash completion from what the program says of itself.

manual.py TROFFER VERSION FOLDER: writes troffer.1, troffer-COMMAND.1 and troffer.bash there.
"""
import pathlib
import re
import subprocess
import sys


def help_of(program, *command):
    return subprocess.run([program, *command, '--help'], check=True, capture_output=True,
                          text=True).stdout


def sections(text):
    """The first line, and {heading: [(term, description)]} of what follows."""
    lines = text.splitlines()
    found, rows = {}, None
    for line in lines[1:]:
        if re.fullmatch(r'[A-Z][A-Za-z ]*:', line):
            rows = found.setdefault(line[:-1], [])
        elif rows is not None and re.match(r'  \S', line):
            term, _, description = re.sub(r'\s{2,}', '\t', line.strip()).partition('\t')
            rows.append([term, description])
        elif rows and line.strip():
            rows[-1][1] = (rows[-1][1] + ' ' + line.strip()).strip()
    return lines[0], found


def roff(text):
    text = text.replace('\\', '\\e').replace('-', '\\-')
    return '\\&' + text if text[:1] in '.\'' else text


# "--error FLOAT:FLOAT in [1e-06 - 1]=0.01" -> option and what follows it.
def option_parts(term):
    names, _, value = term.partition(' ')
    return names, value.replace(' ...', '').replace('REQUIRED', '').strip()


def page(name, version, summary, synopsis, body, others):
    out = [f'.TH {name.upper()} 1 "" "troffer {version}" "User Commands"', '.SH NAME',
           f'{roff(name)} \\- {roff(summary)}', '.SH SYNOPSIS', f'.B {roff(synopsis)}']
    for heading, rows in body.items():
        out.append(f'.SH {heading.upper()}')
        for term, description in rows:
            names, value = option_parts(term)
            out += ['.TP', f'\\fB{roff(names)}\\fR {roff(value)}'.rstrip(), roff(description)]
    out += ['.SH EXIT STATUS', '0: done; 1: a file that cannot be used, or the machine fails; '
            '2: a wrong command line; 130: interrupted, what was finished is written.']
    if others:
        out += ['.SH SEE ALSO', ', '.join(f'\\fB{roff(o)}\\fR(1)' for o in others)]
    return '\n'.join(out) + '\n'


def completion(options):
    cases = '\n'.join(f'    {command}) words="{" ".join(words)}" ;;'
                      for command, words in options.items())
    return f'''# bash completion for troffer
_troffer() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} words
  if [ "$COMP_CWORD" = 1 ]; then
    COMPREPLY=($(compgen -W "{' '.join(options)} --help --version" -- "$word"))
    return
  fi
  case ${{COMP_WORDS[1]}} in
{cases}
  esac
  if [[ $word == -* ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$word"))
  else
    COMPREPLY=($(compgen -f -- "$word"))
  fi
}}
complete -o filenames -F _troffer troffer
'''


def main():
    program, version, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    summary, whole = sections(help_of(program))
    commands = [term for term, _ in whole['Subcommands']]
    others = [f'troffer-{c}' for c in commands]
    options = {}
    for command in commands:
        about, body = sections(help_of(program, command))
        arguments = ' '.join(term.split()[0].upper() for term, _ in body.get('Positionals', []))
        name = f'troffer-{command}'
        text = page(name, version, about, f'troffer {command} {arguments} [OPTIONS]', body,
                    ['troffer'] + [o for o in others if o != name])
        (folder / f'{name}.1').write_text(text, encoding='utf-8')
        options[command] = [n for term, _ in body['Options']
                            for n in option_parts(term)[0].split(',') if n.startswith('--')]
    (folder / 'troffer.bash').write_text(completion(options), encoding='utf-8')
    # Last: it says that all is there.
    whole['Commands'] = whole.pop('Subcommands')
    (folder / 'troffer.1').write_text(
        page('troffer', version, summary, 'troffer COMMAND [OPTIONS]', whole, others),
        encoding='utf-8')


if __name__ == '__main__':
    main()
