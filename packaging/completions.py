#!/usr/bin/env python3
"""Writes completions of the shells bash and zsh from what `tenebra COMMAND --help` says.

Usage: completions.py PROGRAM FOLDER
Writes FOLDER/bash-completion/completions/tenebra and FOLDER/zsh/vendor-completions/_tenebra.
"""
import pathlib
import re
import subprocess
import sys

OPTION = re.compile(r"^  (?:(-\w),)?(--[\w-]+)(?: (\S+))?")
COMMAND = re.compile(r"^  ([a-z]+) {3,}(\S.*)")
CHOICE = re.compile(r"^[a-z0-9]+(\|[a-zN0-9]+)+$")


def help_of(program, *command):
    return subprocess.run([program, *command, "--help"], check=True, capture_output=True, text=True).stdout


def commands_of(text):
    """Pairs of a command and what it does."""
    listed = text.partition("Subcommands:\n")[2].partition("\n\n")[0]
    return [match.groups() for match in map(COMMAND.match, listed.splitlines()) if match]


def kind_of(value):
    """What completes an option's value: the words to choose from, files, folders, or nothing that is known."""
    if value is None or value in ("Excludes:", "Needs:"):
        return "flag"
    if CHOICE.match(value):
        return " ".join(word for word in value.split("|") if word.islower() or word.isdigit())
    return {"FILE": "@files", "DIR": "@folders"}.get(value.split(".")[0], "@none")


def options_of(text):
    """Pairs of a name and what completes its value."""
    found = []
    for match in filter(None, map(OPTION.match, text.splitlines())):
        short, name, value = match.groups()
        found += [(spelling, kind_of(value)) for spelling in (short, name) if spelling]
    return found


def tree_of(program):
    """The options of each command, by its words: "render", "log merge"."""
    tree = {}
    for command, _ in commands_of(help_of(program)):
        text = help_of(program, command)
        parts = commands_of(text)
        tree[command] = [(part, "command") for part, _ in parts] + options_of(text)
        for part, _ in parts:
            tree[f"{command} {part}"] = options_of(help_of(program, command, part))
    return tree


BASH = """# Completion of the commands and options of tenebra. Made from its help.
_tenebra() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} command=${{COMP_WORDS[1]}}
  local -A words=({words})
  local -A values=({values})
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W "{commands} --help --version" -- "$current")
    return
  fi
  [[ -n ${{words["$command ${{COMP_WORDS[2]}}"]}} && $COMP_CWORD -gt 2 ]] && command+=" ${{COMP_WORDS[2]}}"
  local value=${{values["$command $previous"]}}
  case $value in
    @none) return ;;
    @files) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -f -- "$current"); return ;;
    @folders) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- "$current"); return ;;
    ?*) mapfile -t COMPREPLY < <(compgen -W "$value" -- "$current"); return ;;
  esac
  mapfile -t COMPREPLY < <(compgen -W "${{words[$command]}}" -- "$current")
  if [[ $current != -* && $command != log ]]; then
    compopt -o filenames
    mapfile -t -O ${{#COMPREPLY[@]}} COMPREPLY < <(compgen -f -- "$current")
  fi
}}
complete -F _tenebra tenebra
"""

ZSH = """#compdef tenebra
# Completion of the commands and options of tenebra. Made from its help.
_tenebra() {{
  local -A names=({words})
  local -A kinds=({values})
  if ((CURRENT == 2)); then
    compadd -- {commands} --help --version
    return
  fi
  local command=${{words[2]}}
  local part="$command ${{words[3]}}"
  [[ $CURRENT -gt 3 && -n ${{names[$part]}} ]] && command=$part
  local asked="$command ${{words[CURRENT-1]}}"
  case ${{kinds[$asked]}} in
    @none) return ;;
    @files) _files; return ;;
    @folders) _files -/; return ;;
    ?*) compadd -- ${{=kinds[$asked]}}; return ;;
  esac
  compadd -- ${{=names[$command]}}
  [[ $PREFIX == -* || $command == log ]] || _files
}}
_tenebra "$@"
"""


def lists_of(tree, form):
    """What follows each command, and what completes each option's value, as entries of a shell's list."""
    words = " ".join(form(command, " ".join(name for name, kind in options if name))
                     for command, options in tree.items())
    values = " ".join(form(f"{command} {name}", kind) for command, options in tree.items()
                      for name, kind in options if kind not in ("flag", "command"))
    return words, values


def bash_of(tree, commands):
    words, values = lists_of(tree, lambda key, value: f"['{key}']='{value}'")
    return BASH.format(words=words, values=values, commands=" ".join(commands))


def zsh_of(tree, commands):
    words, values = lists_of(tree, lambda key, value: f"'{key}' '{value}'")
    return ZSH.format(words=words, values=values, commands=" ".join(commands))


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    tree = tree_of(program)
    commands = [command for command in tree if " " not in command]
    for name, text in (("bash-completion/completions/tenebra", bash_of(tree, commands)),
                       ("zsh/vendor-completions/_tenebra", zsh_of(tree, commands))):
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
