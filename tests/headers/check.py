#!/usr/bin/env python3
"""Checks that headers compile alone: the public ones, and others without a .cpp file of their own.

    check.py BUILD_FOLDER COMPILER [OPTIONS]

A header with its own .cpp is the first include of that file (the test `layers` checks it), so builds
file by file (presets debug and asan) cover it.

A source per header would compile what headers share again and again. Two facts save most of that,
since no header has declarations before its last #include (checked here):

- If each header of a list includes the one before it, directly or not, a source may include the list
  in this order. It compiles each as if it were alone: what the earlier ones bring, the header
  includes itself.
- Likewise a source may begin with precompiled headers, all of which its first header includes.

Sources that have passed with the same text and compiler are not compiled again.
"""
import concurrent.futures
import hashlib
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# Sets of headers to precompile. A header takes the first set that it includes as a whole.
SHARED = [
    "functional span light/light_primitive.h".split(),
    "span scene/scene.h".split(),
    "array string vector base/vec.h".split(),
    "string vector".split(),
    "base/vec.h".split(),
    [],
]
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*[<"]([^>"]+)[>"]', re.M)
DECLARATION = re.compile(r"^(?:namespace|struct|class|enum|template|using|inline)\b", re.M)


def read_headers():
    """Texts of all headers by the name that other sources include them by."""
    texts = {}
    for folder, pattern in (("src", "**/*.h"), ("include", "troffer/*.h")):
        for path in sorted((ROOT / folder).glob(pattern)):
            texts[str(path.relative_to(ROOT / folder))] = path.read_text()
    return texts


def find_late_includes(texts):
    """Headers that include another after their first declaration."""
    late = []
    for name, text in texts.items():
        first = DECLARATION.search(text)
        if first and INCLUDE.search(text, first.end()):
            late.append(name)
    return late


class Includes:
    """What headers include, directly or not: own headers and others."""

    def __init__(self, texts):
        self.texts = texts
        self.cache = {}

    def of(self, name):
        if name not in self.cache:
            own, other = set(), set()
            for include in INCLUDE.findall(self.texts[name]):
                if include in self.texts:
                    below = self.of(include)
                    own |= below[0] | {include}
                    other |= below[1]
                else:
                    other.add(include)
            self.cache[name] = own, other
        return self.cache[name]


def divide_into_chains(names, includes):
    """As few chains as possible, each a list of headers that include their predecessors."""
    before, after = {}, {}

    def find_predecessor(name, seen):
        for other in sorted(includes.of(name)[0]):
            if other in group and other not in seen:
                seen.add(other)
                if other not in after or find_predecessor(after[other], seen):
                    after[other], before[name] = name, other
                    return True
        return False

    group = set(names)
    for name in names:
        find_predecessor(name, set())
    chains = []
    for name in names:
        if name not in before:
            chain = [name]
            while chain[-1] in after:
                chain.append(after[chain[-1]])
            chains.append(chain)
    return chains


def plan_sources(names, includes):
    """(set of shared headers, chain) of each source."""
    groups = [[] for _ in SHARED]
    for name in names:
        own, other = includes.of(name)
        groups[next(i for i, shared in enumerate(SHARED) if (own | other).issuperset(shared))].append(name)
    return [(i, chain) for i, group in enumerate(groups) for chain in divide_into_chains(group, includes)]


class Compiler:
    def __init__(self, folder, command):
        self.folder = folder
        self.command = command
        version = subprocess.run([command[0], "--version"], capture_output=True, check=True).stdout
        self.identity = version + repr(command).encode() + Path(__file__).read_bytes()

    def precompile(self, i):
        header = self.folder / f"shared{i}.h"
        header.write_text("".join(f"#include <{name}>\n" for name in SHARED[i]))
        subprocess.run([*self.command, "-x", "c++-header", str(header), "-o", f"{header}.gch"], check=True)

    def check(self, i, chain, includes):
        """Messages of the compiler, empty if all headers of the chain compile alone."""
        source = "".join(f'#include "{name}"\n' for name in chain)
        read = sorted(set(chain).union(*(includes.of(name)[0] for name in chain)))
        text = "".join(f"{name}\n{includes.texts[name]}" for name in read)
        stamp = self.folder / hashlib.sha256(self.identity + source.encode() + text.encode()).hexdigest()
        if stamp.exists():
            return ""
        shared = ["-include", str(self.folder / f"shared{i}.h")] if SHARED[i] else []
        done = subprocess.run([*self.command, *shared, "-fsyntax-only", "-x", "c++", "-"], input=source,
                              capture_output=True, text=True)
        if done.returncode == 0:
            stamp.touch()
            return ""
        return f"{' '.join(chain)}:\n{done.stderr}"


def main():
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    texts = read_headers()
    late = find_late_includes(texts)
    if late:
        sys.exit("#include after declarations: " + " ".join(late))
    includes = Includes(texts)
    compiler = Compiler(folder, sys.argv[2:])
    names = [name for name in texts if not (ROOT / "src" / name).with_suffix(".cpp").exists()]
    sources = plan_sources(names, includes)
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        list(pool.map(compiler.precompile, sorted({i for i, _ in sources if SHARED[i]})))
        messages = list(pool.map(lambda source: compiler.check(*source, includes), sources))
    failed = [message for message in messages if message]
    print(f"{len(names)} headers in {len(sources)} sources, {len(failed)} of which fail")
    sys.exit("\n".join(failed) if failed else 0)


if __name__ == "__main__":
    main()
