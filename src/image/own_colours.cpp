#include "image/own_colours.h"

#include <lcms2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "base/rgb.h"
#include "image/raster.h"

namespace troffer {

namespace {

struct Release {
  void operator()(cmsContext c) const { cmsDeleteContext(c); }
};
struct Close {
  void operator()(cmsHPROFILE p) const { cmsCloseProfile(p); }
};
struct Delete {
  void operator()(cmsHTRANSFORM t) const { cmsDeleteTransform(t); }
};
using Context = std::unique_ptr<std::remove_pointer_t<cmsContext>, Release>;
using Profile = std::unique_ptr<void, Close>;
using Transform = std::unique_ptr<void, Delete>;

struct Curve {
  cmsToneCurve* curve;
  explicit Curve(cmsToneCurve* c) : curve(c) {}
  ~Curve() {
    if (curve != nullptr) cmsFreeToneCurve(curve);
  }
  Curve(const Curve&) = delete;
  Curve& operator=(const Curve&) = delete;
};

bool is_about(float a, float b) {
  return std::abs(a - b) <= 0.01f;
}

void encode(Raster& raster, float gamma) {
  const auto linear = [&](float v) { return std::pow(std::max(v, 0.0f), 1 / gamma); };
  const size_t channels = size_t(raster.channels), colours = raster.colours();
  std::array<uint8_t, 256> bytes;
  for (size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = uint8_t(std::lround(255 * srgb_from_linear(linear(float(i) / 255))));
  for (size_t i = 0; i < raster.texels8.size(); ++i)
    if (i % channels < colours) raster.texels8[i] = bytes[raster.texels8[i]];
  for (size_t i = 0; i < raster.texels_float.size(); ++i)
    if (i % channels < colours)
      raster.texels_float[i] = srgb_from_linear(linear(raster.texels_float[i]));
}

ColoursFound obey_gamma(Raster& raster, float gamma) {
  constexpr float least = 0.1f, most = 5;  // plausible range
  if (!(gamma >= least && gamma <= most)) return ColoursFound::broken;
  if (is_about(gamma, 1 / 2.2f)) return ColoursFound::none;
  if (is_about(gamma, 1))
    raster.is_srgb = false;
  else
    encode(raster, gamma);
  return ColoursFound::obeyed;
}

// Returns an sRGB profile, or a grey one with its transfer function.
Profile wanted_profile(cmsContext context, bool is_grey) {
  if (!is_grey) return Profile(cmsCreate_sRGBProfileTHR(context));
  const std::array<double, 5> srgb{2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045};
  const Curve curve(cmsBuildParametricToneCurve(context, 4, srgb.data()));
  if (curve.curve == nullptr) return nullptr;
  return Profile(cmsCreateGrayProfileTHR(context, cmsD50_xyY(), curve.curve));
}

Transform transform_between(cmsContext context, const Profile& from, const Profile& to,
                            cmsUInt32Number format, cmsUInt32Number flags) {
  return Transform(cmsCreateTransformTHR(context, from.get(), format, to.get(), format,
                                         INTENT_RELATIVE_COLORIMETRIC, flags));
}

cmsUInt32Number format_of(bool is_grey, bool has_extra, bool is_float) {
  const auto colours = cmsUInt32Number(is_grey ? PT_GRAY : PT_RGB);
  return COLORSPACE_SH(colours) | EXTRA_SH(has_extra ? 1U : 0U) | CHANNELS_SH(is_grey ? 1U : 3U) |
         BYTES_SH(is_float ? 4U : 1U) | FLOAT_SH(is_float ? 1U : 0U);
}

// True if 8-bit colours stay unchanged up to rounding.
bool changes_nothing(cmsHTRANSFORM transform, bool is_grey) {
  constexpr int steps = 6, most = 1;
  const int colours = is_grey ? 1 : 3;
  for (int i = 0; i < steps * steps * steps; ++i) {
    const std::array<int, 3> at{i % steps, i / steps % steps, i / (steps * steps)};
    std::array<uint8_t, 3> in{}, out{};
    for (size_t k = 0; k < 3; ++k) in[k] = uint8_t(255 * at[k] / (steps - 1));
    cmsDoTransform(transform, in.data(), out.data(), 1);
    for (size_t k = 0; k < size_t(colours); ++k)
      if (std::abs(int(in[k]) - int(out[k])) > most) return false;
  }
  return true;
}

ColoursFound obey_profile(Raster& raster, const std::vector<uint8_t>& bytes) {
  const Context context(cmsCreateContext(nullptr, nullptr));
  if (!context) return ColoursFound::broken;
  cmsSetLogErrorHandlerTHR(context.get(), [](cmsContext, cmsUInt32Number, const char*) {});
  const Profile own(
      cmsOpenProfileFromMemTHR(context.get(), bytes.data(), cmsUInt32Number(bytes.size())));
  if (!own) return ColoursFound::broken;
  const bool is_grey = raster.colours() == 1;
  if (cmsGetColorSpace(own.get()) != (is_grey ? cmsSigGrayData : cmsSigRgbData))
    return ColoursFound::broken;
  const Profile wanted = wanted_profile(context.get(), is_grey);
  if (!wanted) return ColoursFound::broken;
  const Transform plain =
      transform_between(context.get(), own, wanted, format_of(is_grey, false, false), 0);
  if (!plain) return ColoursFound::broken;
  if (changes_nothing(plain.get(), is_grey)) return ColoursFound::none;

  const bool is_float = raster.texels8.empty(),
             is_extra = raster.colours() < size_t(raster.channels);
  const Transform transform =
      transform_between(context.get(), own, wanted, format_of(is_grey, is_extra, is_float),
                        is_extra ? cmsUInt32Number(cmsFLAGS_COPY_ALPHA) : 0);
  if (!transform) return ColoursFound::broken;
  const auto width = cmsUInt32Number(raster.width);
  const size_t row = size_t(raster.width) * size_t(raster.channels);
  for (size_t y = 0; y < size_t(raster.height); ++y) {
    void* const at = is_float ? static_cast<void*>(raster.texels_float.data() + y * row)
                              : static_cast<void*>(raster.texels8.data() + y * row);
    cmsDoTransform(transform.get(), at, at, width);
  }
  for (float& v : raster.texels_float) v = std::isfinite(v) ? std::clamp(v, 0.0f, 1.0f) : 0.0f;
  return ColoursFound::obeyed;
}

}  // namespace

ColoursFound convert_to_srgb(Raster& raster) {
  const OwnColours own = std::move(raster.own);
  raster.own = {};
  if (own.is_empty() || !raster.is_srgb) return ColoursFound::none;
  return own.profile.empty() ? obey_gamma(raster, own.gamma) : obey_profile(raster, own.profile);
}

}  // namespace troffer
