"""Analyses the paper's crop: where source D is sampled, its visible share at each point, and the
errors of every picture to the norm, to a converged reference, and in D's light alone."""

import math
from dataclasses import dataclass

import numpy as np

import differences
from settings import sweep_name

# Source D of scenes/kj92room: corner, edges (it emits toward u × v), radiance.
D_CORNER, D_U, D_V, D_RADIANCE = (1.25, 0.95, 2.99), (0, 1.5, 0), (1.5, 0, 0), 4.0


@dataclass
class Point:
    """Measurements of one rendering of the crop."""

    method: str
    variance: float  # allowed variance; NaN for fixed rays
    rays: float  # shadow rays per viewing ray, mean over the picture
    rays_floor: float  # the same over the floor, where D is sampled
    norm: differences.Difference  # to the norm picture (figure 7c)
    reference: differences.Difference  # to the converged reference
    shadow_error: float  # RMSE of D's direct light on the floor, over its mean unoccluded light
    shadow_bias: float  # mean error of the same
    seconds: float  # wall seconds of rendering alone
    cpu: float  # processor seconds of the whole process


class Crop:
    """`mask`: pixels whose viewing rays all hit the floor and sample D there."""

    def __init__(self, context):
        runs = context.runs
        self.norm = runs["crop-norm"]
        self.reference = runs["crop-reference"]
        self.exact = runs["crop-fixed-reference"].layers["direct"]
        layers = self.norm.layers
        if not np.array_equal(layers["position"], runs["crop-fixed-reference"].layers["position"]):
            raise SystemExit("error: fixed and kj92 do not cast the same viewing rays")
        is_floor = (layers["normal"][..., 2] == 1) & (np.abs(layers["position"][..., 2]) < 1e-4)
        self.mask = is_floor & (layers["sources"][..., 0] == 1)
        # kj92's layer `direct` also holds the other three sources' light, interpolated. It is
        # smooth on the floor, so its remaining noise is averaged away.
        fine = runs["crop-fine"].layers["direct"]
        self.others = differences.smooth(fine - self.exact, self.mask, 4)
        self.unoccluded, self.solid_angle = self._unoccluded(layers)
        visible = self.exact.mean(axis=-1) / np.maximum(self.unoccluded, 1e-12)
        self.visible_share = np.clip(visible, 0, 1)
        self.unoccluded_mean = float(self.unoccluded[self.mask].mean())
        s = context.settings
        self.sweep = {
            is_coherent: [
                self.point(runs[sweep_name(v, is_coherent)],
                           "with coherence" if is_coherent else "without coherence", v)
                for v in s.variances
            ]
            for is_coherent in (False, True)
        }
        self.fixed = [self.point(runs[f"crop-fixed-{n}"], "fixed Owen-Sobol", is_fixed=True)
                      for n in s.fixed_rays]

    @staticmethod
    def _unoccluded(layers):
        shape = layers["position"].shape
        irradiance, angle = differences.irradiance_of_rectangle(
            layers["position"].reshape(-1, 3).astype(float),
            layers["normal"].reshape(-1, 3).astype(float), D_CORNER, D_U, D_V)
        albedo = layers["albedo"].mean(axis=-1)
        return (irradiance.reshape(shape[:2]) * D_RADIANCE * albedo / math.pi,
                angle.reshape(shape[:2]))

    def direct(self, run, is_fixed):
        """Returns D's direct light; valid within the mask."""
        return run.layers["direct"] - (0 if is_fixed else self.others)

    def picture(self, run, is_fixed):
        """Returns the picture. `fixed` has only D's direct light, which replaces that of the norm."""
        if not is_fixed:
            return run.picture
        norm = self.norm
        changed = norm.picture - self.direct(norm, False) + self.direct(run, True)
        return np.where(self.mask[..., None], changed, norm.picture)

    def point(self, run, method, variance=math.nan, is_fixed=False):
        picture = self.picture(run, is_fixed)
        error = (self.direct(run, is_fixed) - self.exact)[self.mask].astype(np.float64)
        rays = run.layers["shadow_rays"][..., 0]
        return Point(method, variance, float(rays.mean()), float(rays[self.mask].mean()),
                     differences.difference(picture, self.norm.picture),
                     differences.difference(picture, self.reference.picture),
                     math.sqrt((error**2).mean()) / self.unoccluded_mean,
                     float(error.mean()) / self.unoccluded_mean,
                     run.stats["seconds"]["render"], run.cpu)

    def error_in(self, region, run, is_fixed=False):
        """Returns the shadow error over one of the regions alone."""
        error = (self.direct(run, is_fixed) - self.exact)[self.regions()[region]]
        return math.sqrt((error.astype(np.float64)**2).mean()) / self.unoccluded_mean

    def regions(self):
        """Returns {name: mask}, by how much the points of the floor see of D."""
        v = self.visible_share
        return {"umbra": self.mask & (v < 0.002),
                "penumbra": self.mask & (v >= 0.002) & (v <= 0.99),
                "lit": self.mask & (v > 0.99)}

    @staticmethod
    def of(context):
        if "crop" not in context.kept:
            context.kept["crop"] = Crop(context)
        return context.kept["crop"]
