"""The experiments as data: their renders, and the functions that make figures of these."""

from dataclasses import dataclass, field

import coherence
import paper
import rooms
from settings import (CROP_CAMERA, DIFFUSE_HALL, FIGURE_VARIANCE, HALL, NO_SECOND_STOP_VARIANCE,
                      ROOM, SELECTION_SCENES, SOURCE_D, no_second_stop_name, refinement_name,
                      selection_name, sweep_name)

@dataclass
class Render:
    name: str
    scene: str
    options: str
    solution: str = ""  # name of the preprocessing that it uses


@dataclass
class Experiment:
    name: str
    title: str
    make: object  # function of a Context, returns a page.Section
    renders: list = field(default_factory=list)
    shown: list = field(default_factory=list)  # names of renders whose commands the page prints


def _crop(s):
    """Returns renders of the paper's crop: only source D is sampled, all four emit."""
    common = f"--size {s.size} {CROP_CAMERA} --method kj92 --select {SOURCE_D}"
    layers = "--aov shadow_rays,sources,direct,indirect,position,normal,albedo"

    def kj92(name, options):
        return Render(name, ROOM, f"{common} {options} {layers}", "kj92room")

    def fixed(name, options):
        view = f"--size {s.size} {CROP_CAMERA} --method fixed --light {SOURCE_D}"
        return Render(name, ROOM, f"{view} {options} --aov shadow_rays,direct,position")

    rays = s.reference_rays
    many = f"--spp {s.reference_spp} --variance 0 --most-rays"
    renders = [
        kj92("crop-1-64", "--spp 1 --variance 0 --most-rays 64"),
        kj92("crop-64-1", "--spp 64 --variance 0 --most-rays 1 --shadow-rays 1"),
        kj92("crop-norm", "--spp 4 --variance 0 --most-rays 64"),
        kj92("crop-reference", f"{many} 64"),
        kj92("crop-fine", f"--spp 4 --variance 0 --most-rays {rays // 2}"),
        fixed("crop-fixed-reference", f"--spp 4 --shadow-rays {rays}"),
    ]
    for is_coherent in (False, True):
        on = "on" if is_coherent else "off"
        renders += [
            kj92(sweep_name(v, is_coherent), f"--spp 4 --variance {v:g} --coherence {on}")
            for v in s.variances
        ]
        renders.append(kj92(no_second_stop_name(is_coherent), f"--spp 4 --coherence {on} "
                            f"--variance {NO_SECOND_STOP_VARIANCE} --mean-change 0"))
    renders += [fixed(f"crop-fixed-{n}", f"--spp 4 --shadow-rays {n}") for n in s.fixed_rays]
    return renders


def _room(s):
    """Returns renders of the whole room with all four sources."""
    layers = "--aov shadow_rays,sources,direct,indirect"
    view = f"--size {s.size} --method kj92"
    return [
        Render("room", ROOM, f"--size {s.room_size} --method kj92 {layers}", "kj92room"),
        Render("room-default", ROOM, f"{view} {layers}"),
        Render("room-d-all", ROOM, f"{view} --select {SOURCE_D} --selection off "
               f"--variance {FIGURE_VARIANCE} {layers}", "kj92room"),
    ]


def _selection(s):
    """Returns renders of direct light only: no rays go to bright patches, and the truth is known."""
    renders = []
    for scene, place, size in SELECTION_SCENES:
        view = f"--size {getattr(s, size)} --spp 4 --indirect none"
        renders.append(Render(f"{scene}-direct", place, f"{view} --method fixed "
                              f"--shadow-rays {s.selection_reference_rays}"))
        renders += [
            Render(selection_name(scene, on, v), place,
                   f"{view} --method kj92 --selection {on} --variance {v:g} "
                   "--aov shadow_rays,sources")
            for on in ("on", "off") for v in s.selection_variances
        ]
    return renders


def _halls(s):
    layers = "--aov shadow_rays,sources,direct,indirect"
    return [
        Render("hall-default", HALL, f"--size {s.hall_size} --method kj92 {layers}"),
        Render("hall-diffuse-default", DIFFUSE_HALL,
               f"--size {s.hall_size} --method kj92 {layers}"),
        Render("hall-path", HALL, f"--size {s.hall_size} --method path "
               f"--spp {s.hall_path_spp}"),
    ]


def _refinement(s):
    return [
        Render(refinement_name(low, high), ROOM,
               f"--size {s.size} --method kj92 --indirect none --variance 0.05 --spp {low} "
               f"--max-spp {high}")
        for low, high in s.refinement
    ]


def experiments(s):
    sweep = [sweep_name(v, c) for c in (False, True) for v in s.variances]
    chosen = [sweep_name(FIGURE_VARIANCE, c) for c in (False, True)]
    fixed = [f"crop-fixed-{n}" for n in s.fixed_rays]
    return [
        Experiment("figure4", "Figure 4: refinement of the bintree over a source", paper.figure4),
        Experiment("figure5", "Figure 5: shrinking of the bintree", paper.figure5),
        Experiment("figure6", "Figure 6: the whole room", rooms.figure6, _room(s), ["room"]),
        Experiment("figure7", "Figure 7: viewing and shadow rays", paper.figure7, _crop(s),
                   ["crop-1-64", "crop-64-1", "crop-norm", *chosen]),
        Experiment("table1", "Table 1: difference from the norm picture", paper.table1, [],
                   ["crop-reference", "crop-fixed-reference", *sweep, *fixed]),
        Experiment("figure8", "Figure 8: rays and difference against the allowed variance",
                   coherence.figure8),
        Experiment("figure9", "Figure 9: where the shadow rays go", coherence.figure9, [],
                   [*chosen, "room-d-all"]),
        Experiment("claims", "What coherence is said to do", coherence.claims, [],
                   [no_second_stop_name(c) for c in (False, True)]),
        Experiment("room", "The whole room against a path-traced reference", rooms.whole_room, [],
                   ["room-default"]),
        Experiment("selection", "What source selection saves", rooms.selection, _selection(s)),
        Experiment("refinement", "Refinement of the image", rooms.refinement, _refinement(s)),
        Experiment("halls", "Two halls through the same pipeline", rooms.halls, _halls(s)),
    ]
