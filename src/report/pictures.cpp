#include "report/pictures.h"

#include "base/units.h"
#include "image/encode.h"
#include "image/exposure.h"

namespace troffer {

ReportPicture make_picture(const PreparedScene& scene, const Camera& camera, RenderOptions options,
                           const ProgressCallback& progress, const StopFlag& stop) {
  options.aovs = {Aov::error};
  const RenderResult r = render(scene, camera, options, progress, stop);
  ReportPicture p;
  p.is_complete = r.is_complete;
  if (!p.is_complete) return p;
  const Image& image = r.layers[0].image;
  const double unit = scene.scene.is_photometric ? 1 : luminous_efficacy;
  p.name = camera.name;
  p.width = image.width;
  p.height = image.height;
  p.scale = luminance_scale(image, unit);
  for (const Rgb& pixel : image.pixels) p.mean += double(luminance(pixel)) * unit;
  p.mean /= double(image.pixels.size());
  p.estimated_error = r.statistics.estimated_error;
  p.seen = encode_png(image, {brightness(image).auto_stops, ToneMap::filmic}, options.threads);
  p.luminances = false_colour_png(image, unit, p.scale);
  return p;
}

}  // namespace troffer
