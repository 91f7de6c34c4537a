"""Scenes, cameras and sizes, for the catalogue and for analyses of its pictures."""

from dataclasses import dataclass

ROOM = "scenes/kj92room/kj92room.gltf"
HALL = "scenes/modern-hall/modern-hall.gltf"
DIFFUSE_HALL = "scenes/modern-hall/modern-hall-diffuse.pbrt"
# By pbrt-v4: 256 × 256, 8192 paths a pixel; the same with direct light only, 2048; 320 × 240, 2048.
ROOM_REFERENCE = "scenes/references/kj92room_full.exr"
ROOM_DIRECT_REFERENCE = "scenes/references/kj92room_direct.exr"
DIFFUSE_HALL_REFERENCE = "scenes/references/modern-hall-diffuse.exr"

# The floor at the left back leg of the table, seen from the front left.
CROP_CAMERA = "--eye 0.7,1.9,0.66 --target 1.38,2.95,0.05 --up 0,0,1 --fov 45"
# Preprocessings that several pictures share: scene, options.
SOLUTIONS = {"kj92room": (ROOM, "")}
# Scenes for selection: name, scene, which of the sizes below.
SELECTION_SCENES = (("kj92room", ROOM, "size"), ("modern-hall", HALL, "small_hall_size"),
                    ("modern-hall-diffuse", DIFFUSE_HALL, "small_hall_size"))
SOURCE_D = "emitter0"
NO_SECOND_STOP_VARIANCE = 0.03  # for coherence without the second stop
FIGURE_VARIANCE = 0.07  # of figures 7d and 9


@dataclass
class Settings:
    """Amounts of computation; `quick` only tries the machinery."""

    size: str = "256x256"
    room_size: str = "512x512"
    hall_size: str = "320x240"
    variances: tuple = (0.01, 0.015, 0.02, 0.03, 0.05, 0.07, 0.1, 0.14, 0.2)
    fixed_rays: tuple = (4, 8, 16, 32, 64, 128)
    reference_rays: int = 1024
    reference_spp: int = 64
    selection_variances: tuple = (0.03, 0.05, 0.1, 0.2, 0.4)
    small_hall_size: str = "160x120"
    selection_reference_rays: int = 256
    hall_path_spp: int = 128
    refinement: tuple = ((1, 1), (2, 2), (4, 4), (8, 8), (16, 16), (1, 8), (2, 16), (4, 32))
    is_quick: bool = False


QUICK = Settings(
    size="64x64",
    room_size="96x96",
    hall_size="80x60",
    variances=(0.05, 0.07, 0.2),
    fixed_rays=(4, 32, 256),
    reference_rays=128,
    reference_spp=8,
    selection_variances=(0.05, 0.2),
    small_hall_size="80x60",
    selection_reference_rays=32,
    hall_path_spp=16,
    refinement=((1, 1), (4, 4), (1, 8)),
    is_quick=True,
)


def sweep_name(variance, is_coherent):
    return f"crop-{'coherent' if is_coherent else 'single'}-{variance:g}"


def no_second_stop_name(is_coherent):
    return f"crop-no-second-stop-{'coherent' if is_coherent else 'single'}"


def selection_name(scene, on, variance):
    return f"{scene}-selection-{on}-{variance:g}"


def refinement_name(low, high):
    return f"refine-{low}-{high}"
