"""Renders everything in the catalogue, makes the figures and writes the page."""

import argparse
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass, field

import catalog
import page
import program
import settings

TITLE = "Adaptive sampling of area light sources: the experiments of 1992, done again"


@dataclass
class Context:
    """Input of the functions that make figures."""

    settings: settings.Settings
    program: program.Program
    out: str
    runs: dict = field(default_factory=dict)  # by name of the render
    kept: dict = field(default_factory=dict)  # values that figures share, by name

    def path(self, file):
        return f"{self.out}/{file}"


def arguments():
    parser = argparse.ArgumentParser(prog="experiments/kj92/run")
    parser.add_argument("--out", default="build/experiments/kj92", metavar="FOLDER",
                        help="where everything is written")
    parser.add_argument("--copy", metavar="FOLDER",
                        help="also write page, pictures and tables there")
    parser.add_argument("--quick", action="store_true", help="small pictures, few points")
    parser.add_argument("--build", default="build/release", metavar="FOLDER",
                        help="the programs built there")
    return parser.parse_args()


def render_all(context, experiments):
    unique = {r.name: r for e in experiments for r in e.renders}
    solutions = sorted({r.solution for r in unique.values() if r.solution})
    context.program.planned = len(unique) + len(solutions)
    for name in solutions:
        context.runs[name] = context.program.radiosity(name, *settings.SOLUTIONS[name])
    for r in unique.values():
        options = r.options
        if r.solution:
            options += f" --solution {context.runs[r.solution].exr}"
        context.runs[r.name] = context.program.render(r.name, r.scene, options)


def commands_of(context, experiment):
    names = experiment.shown or [r.name for r in experiment.renders]
    solutions = [s for s in settings.SOLUTIONS
                 if any(f"/{s}.trad" in context.runs[n].command for n in names)]
    return [context.runs[n].command for n in solutions + names]


def introduction(options, runs):
    minutes = sum(r.cpu for r in runs.values()) / 60
    words = [f"Made by `experiments/kj92/run{' --quick' if options.quick else ''}`, which takes "
             f"{minutes:.0f} minutes of processor time; commands run in the repository's root. "
             "Processor times are those of whole processes, all threads; times by the clock are "
             "longer where the machine had other work."]
    if options.quick:
        words = ["**A quick try of the machinery: small pictures, few points, no results.** "
                 + words[0]]
    words.append(
        "The paper is A. Kok and F. Jansen, \"Adaptive Sampling of Area Light Sources in Ray "
        "Tracing Including Diffuse Interreflection\", Eurographics '92. Its scene is known by "
        "a sketch and its tables' values are lost, so that shapes of curves and what its text "
        "says are compared, not digits. *Viewing rays* are counted per pixel, *shadow rays* "
        "per viewing ray. *Average difference*: mean absolute difference of 8-bit rgb values, "
        "0 to 255.")
    return words


def main():
    options = arguments()
    chosen = settings.QUICK if options.quick else settings.Settings()
    out = options.out + ("/quick" if options.quick else "")
    os.makedirs(out, exist_ok=True)
    experiments = catalog.experiments(chosen)
    context = Context(chosen, program.Program(options.build, out, "build/experiments/kj92"), out)
    subprocess.run([f"{options.build}/bench/kj92_bintree_figures", out], check=True)
    render_all(context, experiments)

    print("== Figures and tables", flush=True)
    sections = []
    for e in experiments:
        section = e.make(context)
        section.commands = section.commands + commands_of(context, e)
        for table in section.tables:
            page.write_csv(out, table)
        sections.append((e, section))
    words = introduction(options, context.runs)
    page.write_html(out, TITLE, words, sections)
    page.write_markdown(out, TITLE, words, sections)
    files = page.files_of(sections)
    size = sum(os.path.getsize(f"{out}/{f}") for f in files)
    print(f"{out}/index.html: {len(files)} files, {size / 1e6:.1f} MB")
    if options.copy:
        os.makedirs(options.copy, exist_ok=True)
        for f in files:
            shutil.copyfile(f"{out}/{f}", f"{options.copy}/{f}")


if __name__ == "__main__":
    sys.exit(main())
