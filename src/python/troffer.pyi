"""Light in rooms: pictures, illuminance at points, and years of daylight."""

import os
from collections.abc import Callable, Sequence
from typing import Any, TypedDict, Union

import numpy as np
import numpy.typing as npt
from typing_extensions import Unpack

__version__: str

Path = Union[str, bytes, os.PathLike[Any]]
Triple = Union[tuple[float, float, float], Sequence[float], npt.NDArray[Any]]
Colour = Union[float, Triple]
Floats = npt.NDArray[np.float32]
Doubles = npt.NDArray[np.float64]
Progress = Callable[[float], Any]

class InputError(ValueError): ...

class _LightOptions(TypedDict, total=False):
    method: str
    indirect: str
    error: float
    spp: int
    depth: int
    threads: int
    seed: int
    variance: float | None
    most_rays: int | None
    mean_change: float | None
    level_difference: int | None
    probe_rays: int | None
    coherence: bool
    ratio: bool
    selection: bool
    select: Sequence[str]
    progress: Progress | None

class _RenderOptions(_LightOptions, total=False):
    width: int
    height: int
    crop: tuple[int, int, int, int] | None
    max_spp: int
    shadow_rays: int | None
    aovs: Sequence[str]
    time_limit: float
    error_limit: float

class _AnnualOptions(TypedDict, total=False):
    north: float
    ground: float
    occupancy: Path
    groups: Path | None
    blinds: Path
    threshold: float
    subdivision: int
    gather_rays: int
    eyes: npt.ArrayLike | None
    sunlight: npt.ArrayLike | None
    sunlight_day: str
    electric: Sequence[str] | str | None
    electric_target: float
    threads: int
    seed: int
    progress: Progress | None

class _MaterialOptions(TypedDict, total=False):
    base_color: Colour
    base_color_texture: Texture
    roughness: float
    roughness_texture: Texture
    metallic: float
    metallic_texture: Texture
    ior: float
    specular: float
    specular_color: Colour
    transmission: float
    diffuse_transmission: float
    thin: bool
    absorption: Colour
    coat: float
    coat_roughness: float
    coat_ior: float
    sheen_color: Colour
    sheen_roughness: float
    anisotropy: float
    anisotropy_rotation: float
    normal_texture: Texture
    normal_scale: float
    alpha_cut: float | None
    back: str

class Camera:
    @property
    def name(self) -> str: ...

class Light:
    dimmer: float
    radiance: Triple
    @property
    def name(self) -> str: ...
    @property
    def kind(self) -> str: ...
    @property
    def count(self) -> int: ...

class Material:
    base_color: Triple
    roughness: float
    metallic: float
    ior: float
    specular: float
    transmission: float
    diffuse_transmission: float
    coat: float
    coat_roughness: float
    @property
    def name(self) -> str: ...

class Texture: ...

class Picture:
    @property
    def pixels(self) -> Floats: ...
    @property
    def layers(self) -> list[str]: ...
    @property
    def error(self) -> float: ...
    @property
    def is_complete(self) -> bool: ...
    @property
    def stats(self) -> dict[str, Any]: ...
    def save(self, path: Path, *, exposure: float | None = None, filmic: bool = True) -> None: ...
    def __getitem__(self, layer: str) -> Floats: ...
    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]: ...
    def _repr_png_(self) -> bytes: ...

class Measurements:
    @property
    def illuminance(self) -> Doubles: ...
    @property
    def standard_error(self) -> Doubles: ...
    @property
    def irradiance(self) -> Floats: ...
    @property
    def is_complete(self) -> bool: ...
    def __len__(self) -> int: ...

class AnnualGrid:
    @property
    def name(self) -> str: ...
    @property
    def total(self) -> Floats: ...
    @property
    def standard_error(self) -> Floats: ...
    @property
    def direct(self) -> Floats: ...
    @property
    def metrics(self) -> dict[str, Doubles]: ...
    @property
    def metric_errors(self) -> dict[str, Doubles]: ...
    @property
    def figures(self) -> dict[str, tuple[float, float]]: ...
    @property
    def requirements(self) -> list[dict[str, Any]]: ...
    @property
    def electric(self) -> dict[str, tuple[Doubles, Doubles]]: ...
    def __len__(self) -> int: ...

class AnnualEye:
    @property
    def vertical(self) -> Floats: ...
    @property
    def dgp(self) -> Floats: ...
    @property
    def shares(self) -> dict[float, float]: ...
    @property
    def level(self) -> str: ...

class AnnualDaylight:
    @property
    def grids(self) -> list[AnnualGrid]: ...
    @property
    def hours(self) -> Doubles: ...
    @property
    def occupied(self) -> npt.NDArray[np.bool_]: ...
    @property
    def states(self) -> dict[str, tuple[list[str], npt.NDArray[np.uint16]]]: ...
    @property
    def eyes(self) -> list[AnnualEye]: ...
    @property
    def sunlight(self) -> list[tuple[float, str]]: ...
    @property
    def electric(self) -> dict[str, dict[str, float]]: ...
    @property
    def place(self) -> str: ...
    @property
    def error(self) -> float: ...
    @property
    def is_complete(self) -> bool: ...
    def __getitem__(self, name: str) -> AnnualGrid: ...

class Scene:
    def __init__(self, *, up: Triple = (0, 0, 1), photometric: bool = True) -> None: ...
    @property
    def file(self) -> str: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def is_photometric(self) -> bool: ...
    @property
    def triangles(self) -> int: ...
    @property
    def up(self) -> Triple: ...
    @property
    def bounds(self) -> tuple[Triple, Triple]: ...
    @property
    def cameras(self) -> list[str]: ...
    @property
    def lights(self) -> list[Light]: ...
    @property
    def materials(self) -> list[Material]: ...
    def light(self, name: str) -> Light: ...
    def material(self, name: str) -> Material: ...
    def dim(self, name: str, factor: float) -> None: ...
    def camera(self, name: str = "") -> Camera: ...
    def look_at(
        self,
        eye: Triple,
        target: Triple,
        *,
        up: Triple | None = None,
        fov: float = 60,
        lens_radius: float = 0,
        focal_distance: float = 0,
    ) -> Camera: ...
    def add_camera(
        self,
        name: str,
        eye: Triple,
        target: Triple,
        *,
        up: Triple | None = None,
        fov: float = 60,
        lens_radius: float = 0,
        focal_distance: float = 0,
    ) -> None: ...
    def add_image(
        self,
        pixels: npt.NDArray[Any],
        *,
        srgb: bool | None = None,
        repeat: bool = True,
        filtered: bool = True,
    ) -> Texture: ...
    def add_material(
        self, name: str, model: str = "matte", **arguments: Unpack[_MaterialOptions]
    ) -> Material: ...
    def add_mesh(
        self,
        positions: npt.ArrayLike,
        triangles: npt.ArrayLike,
        normals: npt.ArrayLike | None = None,
        uvs: npt.ArrayLike | None = None,
        *,
        material: str | Material | None = None,
        emission: Colour | None = None,
        two_sided: bool = False,
        emission_texture: Texture | None = None,
        name: str = "",
        transform: npt.ArrayLike | None = None,
    ) -> None: ...
    def add_sphere(
        self,
        centre: Triple,
        radius: float,
        *,
        material: str | Material | None = None,
        emission: Colour | None = None,
        name: str = "",
    ) -> None: ...
    def add_point_light(self, name: str, position: Triple, intensity: Colour) -> None: ...
    def add_spot_light(
        self,
        name: str,
        position: Triple,
        direction: Triple,
        intensity: Colour,
        *,
        inner: float = 0,
        outer: float = 45,
    ) -> None: ...
    def add_distant_light(self, name: str, direction: Triple, irradiance: Colour) -> None: ...
    def add_luminaire(
        self,
        name: str,
        file: Path,
        position: Triple,
        *,
        nadir: Triple | None = None,
        rotation: float = 0,
        dimming: float = 1,
        lumens: float | None = None,
        kelvin: float | None = None,
    ) -> None: ...
    def add_environment(
        self, image: npt.NDArray[Any], *, scale: float = 1, rotation: float = 0
    ) -> None: ...
    def add_sky(
        self,
        kind: str = "overcast",
        *,
        lux: float | None = None,
        sun: tuple[float, float] | None = None,
        north: float = 0,
        ground: float = 0.2,
    ) -> None: ...
    def add_light(self, **asked: Any) -> None: ...
    def render(
        self, camera: str | Camera | None = None, **arguments: Unpack[_RenderOptions]
    ) -> Picture: ...
    def measure(
        self, points: npt.ArrayLike, **arguments: Unpack[_LightOptions]
    ) -> Measurements: ...
    def annual(
        self,
        weather: Path,
        grids: npt.ArrayLike | dict[str, npt.ArrayLike] | None = None,
        **arguments: Unpack[_AnnualOptions],
    ) -> AnnualDaylight: ...

def load(
    file: Path,
    *,
    variant: str | None = None,
    time: float | None = None,
    animation: str | None = None,
    emission_scale: float = 1,
    baked: bool = False,
) -> Scene: ...
def compare(image: npt.ArrayLike, reference: npt.ArrayLike) -> dict[str, float]: ...
def read_image(path: Path) -> Floats: ...
def write_image(
    path: Path, pixels: npt.ArrayLike, *, exposure: float = 0, filmic: bool = False
) -> None: ...
