"""Writes completion for bash, zsh and fish: commands, options, their values and the files they take."""
import program_help


def files_of(option):
    return [] if option['files'] == ['*'] else [e for e in option['files'] if e != '/']


def takes_files(option):
    return bool(option['files'])


def positional_endings(command):
    """Returns the endings of a command's positional files; empty if it has no positional."""
    return sorted({e for o in program_help.options(command) if o['is_positional']
                   for e in o['files']})


BASH = '''# bash completion for troffer

# Files and folders that begin like $word; of files only those with these endings (none: all).
_troffer_files() {
  local file ending
  COMPREPLY=()
  while IFS= read -r file; do
    if [ -d "$file" ] || [ $# = 0 ]; then COMPREPLY+=("$file"); continue; fi
    for ending in "$@"; do
      if [[ ${file,,} == *."$ending" ]]; then COMPREPLY+=("$file"); break; fi
    done
  done < <(compgen -f -- "$word")
}

_troffer() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words
  COMPREPLY=()
  if [ "$COMP_CWORD" = 1 ]; then
    COMPREPLY=($(compgen -W "@COMMANDS@ help --help --version" -- "$word"))
    return
  fi
  # --option=value arrives as three words.
  if [ "$word" = = ]; then word=; elif [ "$before" = = ]; then before=${COMP_WORDS[COMP_CWORD-2]}; fi
  case "${COMP_WORDS[1]} $before" in
    help\\ *) COMPREPLY=($(compgen -W "@COMMANDS@" -- "$word")); return ;;
@VALUES@
  esac
  case ${COMP_WORDS[1]} in
@OPTIONS@
  esac
}
complete -o filenames -F _troffer troffer
'''


def bash(help_):
    values, options = {}, []
    for command in help_['commands']:
        name = command['name']
        for o in program_help.options(command):
            if o['is_positional'] or not o['value']:
                continue
            if o['choices']:
                action = f'COMPREPLY=($(compgen -W "{" ".join(o["choices"])}" -- "$word"))'
            elif takes_files(o):
                action = ' '.join(['_troffer_files', *files_of(o)])
            else:
                action = ':'  # a number or a name: nothing to complete
            for n in o['names']:
                values.setdefault(action, []).append(f'{name}\\ {n}')
        names = [n for o in program_help.options(command) if not o['is_positional']
                 for n in program_help.long_names(o)]
        endings = ' '.join(positional_endings(command))
        options.append(f'    {name})\n      if [[ $word == -* ]]; then\n'
                       f'        COMPREPLY=($(compgen -W "{" ".join(names)}" -- "$word"))\n'
                       f'      else\n        _troffer_files {endings}\n      fi ;;')
    cases = [f'    {"|".join(patterns)}) {action}; return ;;'
             for action, patterns in values.items()]
    commands = ' '.join(c['name'] for c in help_['commands'])
    return (BASH.replace('@COMMANDS@', commands).replace('@VALUES@', '\n'.join(cases))
            .replace('@OPTIONS@', '\n'.join(options)))


def zsh_quoted(text):
    for a, b in (('\\', '\\\\'), ("'", "'\\''"), ('[', '\\['), (']', '\\]'), (':', '\\:')):
        text = text.replace(a, b)
    return text


def zsh_action(option):
    if option['choices']:
        return f'({" ".join(option["choices"])})'
    if option['files'] == ['/']:
        return '_files -/'
    endings = files_of(option)
    if endings:
        return f'_files -g "*.({"|".join(endings)})(-.)"'
    return '_files' if takes_files(option) else ' '


def zsh_specs(command):
    for o in program_help.options(command):
        text, value = zsh_quoted(o['text']), zsh_quoted(o['value'] or o['names'][0])
        if o['is_positional']:
            place = '*' if o['is_repeatable'] else ''
            yield f"'{place}:{value}:{zsh_action(o)}'"
            continue
        for n in o['names']:
            repeat = '*' if o['is_repeatable'] else ''
            tail = f':{value}:{zsh_action(o)}' if o['value'] else ''
            yield f"'{repeat}{n}[{text}]{tail}'"


def zsh(help_):
    out = ['#compdef troffer', '', '_troffer() {', '  local context state line',
           '  typeset -A opt_args',
           "  _arguments -C '1:command:->command' '*::argument:->argument'",
           '  case $state in', '  command)', '    local -a commands=(']
    out += [f"      '{c['name']}:{zsh_quoted(c['summary'])}'" for c in help_['commands']]
    out += ["      'help:List the commands, or the options of a command'", '    )',
            "    _describe command commands ;;", '  argument)', '    case $line[1] in']
    for c in help_['commands']:
        out.append(f"    {c['name']}) _arguments \\")
        specs = list(zsh_specs(c))
        out += [f'      {s} \\' for s in specs[:-1]] + [f'      {specs[-1]} ;;']
    names = ' '.join(c['name'] for c in help_['commands'])
    out += [f"    help) _arguments '1:command:({names})' ;;", '    esac ;;', '  esac', '}', '',
            '_troffer "$@"']
    return '\n'.join(out) + '\n'


def fish_quoted(text):
    return "'" + text.replace('\\', '\\\\').replace("'", "\\'") + "'"


def fish(help_):
    out = ['# fish completion for troffer', 'complete -c troffer -f']
    for c in help_['commands']:
        out.append(f"complete -c troffer -n __fish_use_subcommand -a {c['name']} "
                   f"-d {fish_quoted(c['summary'])}")
    out.append("complete -c troffer -n __fish_use_subcommand -a help "
               "-d 'List the commands, or the options of a command'")
    names = ' '.join(c['name'] for c in help_['commands'])
    out.append(f"complete -c troffer -n '__fish_seen_subcommand_from help' -a '{names}'")
    for c in help_['commands']:
        seen = f"complete -c troffer -n '__fish_seen_subcommand_from {c['name']}'"
        if positional_endings(c):
            out.append(seen + ' -F')
        for o in program_help.options(c):
            if o['is_positional']:
                continue
            names = ''.join(f' -l {n[2:]}' if n.startswith('--') else f' -s {n[1:]}'
                            for n in o['names'])
            value = ''
            if o['choices']:
                value = f" -x -a '{' '.join(o['choices'])}'"
            elif takes_files(o):
                value = ' -r -F'
            elif o['value']:
                value = ' -x'
            out.append(f"{seen}{names}{value} -d {fish_quoted(o['text'])}")
    return '\n'.join(out) + '\n'
