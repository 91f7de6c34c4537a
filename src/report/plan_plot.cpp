#include "report/plan_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/plan_view.h"
#include "report/svg.h"

namespace troffer {

namespace {

constexpr double margin = 16, foot = 30, compass = 62;  // px: margin; height of the scale bar;
                                                        // width of the north arrow
constexpr double name_size = 10.5, number_size = 10;    // px
constexpr double letter_width = 0.56;  // width of a letter, relative to the text size

class Plan {
 public:
  Plan(const Assessment& a, const Storey& storey, const AssessmentOptions& o, double width,
       double height)
      : a_(a), storey_(storey), options_(o), axes_(plan_axes(o.up)) {
    for (const size_t f : storey.floors) reach(a.floors[f]);
    for (const size_t s : storey.surfaces) reach(a.surfaces[s].surface);
    for (const size_t l : storey.luminaires) reach(axes_.of(a.luminaires[l].position));
    const double w = std::max(upper_.x - lower_.x, 0.5), h = std::max(upper_.y - lower_.y, 0.5);
    scale_ = std::min((width - 2 * margin - compass) / w, (height - 2 * margin - foot) / h);
    width_ = w * scale_ + 2 * margin + compass;
    height_ = h * scale_ + 2 * margin + foot;
  }

  std::string svg() const {
    return svg_element(width_, height_, "plan",
                       floors() + surfaces() + luminaires() + north() + bar());
  }

 private:
  void reach(const Vec2d& p) {
    lower_ = {std::min(lower_.x, p.x), std::min(lower_.y, p.y)};
    upper_ = {std::max(upper_.x, p.x), std::max(upper_.y, p.y)};
  }
  void reach(const AssessedSurface& s) {
    for (const Vec2d& p :
         {Vec2d{0, 0}, Vec2d{s.width, 0}, Vec2d{0, s.height}, Vec2d{s.width, s.height}})
      reach(axes_.of(s.place(p)));
  }
  Vec2d at(const Vec3d& p) const {
    const Vec2d q = axes_.of(p) - lower_;
    return {margin + q.x * scale_, height_ - foot - margin - q.y * scale_};
  }

  std::string filled(const AssessedSurface& s) const {
    std::string path;
    const auto add = [&](const std::vector<Vec2d>& corners) {
      for (size_t k = 0; k < corners.size(); ++k) {
        const Vec2d p = at(s.place(corners[k]));
        path += fmt::format("{}{:.1f},{:.1f}", k == 0 ? "M" : "L", p.x, p.y);
      }
      path += "Z";
    };
    if (s.triangles.empty()) add({{0, 0}, {s.width, 0}, {s.width, s.height}, {0, s.height}});
    for (const PlaneTriangle& t : s.triangles) add({t[0], t[1], t[2]});
    return "<path d=\"" + path + "\"/>";
  }

  std::string rim(const AssessedSurface& s) const {
    std::string out;
    for (const auto& e : s.rim) {
      const Vec2d p = at(s.place(e[0])), q = at(s.place(e[1]));
      out += svg_line(p.x, p.y, q.x, q.y);
    }
    return out;
  }

  std::string floors() const {
    std::string fill, line;
    for (const size_t f : storey_.floors) {
      fill += filled(a_.floors[f]);
      line += rim(a_.floors[f]);
    }
    // A thin stroke closes the seams between triangles.
    return "<g fill=\"#f3f4f6\" stroke=\"#f3f4f6\" stroke-width=\".7\">" + fill +
           "</g><g fill=\"none\" stroke=\"#1b1f24\" stroke-width=\"3\" stroke-linecap=\"round\">" +
           line + "</g>";
  }

  std::string surfaces() const {
    std::string fill, line, text;
    for (const size_t i : storey_.surfaces) {
      const AssessedSurface& s = a_.surfaces[i].surface;
      const bool is_floor = s.kind == SurfaceKind::floor || s.kind == SurfaceKind::work_plane;
      if (!is_floor) {
        fill += filled(s);
        line += rim(s);
      }
      text += label(s, is_floor);
    }
    return "<g fill=\"#dfe8f5\" stroke=\"#dfe8f5\" stroke-width=\".7\">" + fill +
           "</g><g fill=\"none\" stroke=\"#1f4e9e\" stroke-width=\"1.2\">" + line + "</g>" +
           fmt::format("<g font-size=\"{}\" fill=\"#1b1f24\">", name_size) + text + "</g>";
  }

  // Places a surface's name at its lower edge, clear of luminaires over its middle, and cuts it to
  // fit.
  std::string label(const AssessedSurface& s, bool is_floor) const {
    double x0 = width_, x1 = 0, y1 = 0;
    for (const Vec2d& c :
         {Vec2d{0, 0}, Vec2d{s.width, 0}, Vec2d{0, s.height}, Vec2d{s.width, s.height}}) {
      const Vec2d p = at(s.place(c));
      x0 = std::min(x0, p.x);
      x1 = std::max(x1, p.x);
      y1 = std::max(y1, p.y);
    }
    const auto letters = size_t(std::max(4.0, (x1 - x0) / (letter_width * name_size)));
    return svg_text((x0 + x1) / 2, y1 - 6, "middle", shortened(s.name, letters),
                    is_floor ? "fill=\"#56606b\" font-style=\"italic\"" : "");
  }

  // Cuts a name at a complete UTF-8 sequence.
  static std::string shortened(const std::string& name, size_t letters) {
    if (name.size() <= letters) return name;
    size_t n = letters - 1;
    while (n > 0 && (static_cast<unsigned char>(name[n]) & 0xc0) == 0x80) --n;
    return name.substr(0, n) + "…";
  }

  std::string luminaires() const {
    std::string out = fmt::format(
        "<g fill=\"#ffe9a8\" stroke=\"#8a5a00\" stroke-width=\"1\" font-size=\"{}\">", number_size);
    for (const size_t l : storey_.luminaires) {
      const PlacedLuminaire& e = a_.luminaires[l];
      const Vec2d p = at(e.position);
      const std::string number = std::to_string(l + 1);
      const double r = 4 + 0.5 * letter_width * number_size * double(number.size());
      const Vec2d way = axes_.of(e.aim);
      // The arrow is as long as the horizontal part of the aim.
      if (std::hypot(way.x, way.y) > 0.05)
        out += fmt::format("<path d=\"M{:.1f},{:.1f}l{:.1f},{:.1f}\" stroke-width=\"2\"/>", p.x,
                           p.y, way.x * 34, -way.y * 34);
      out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\"/>", p.x, p.y, r) +
             svg_text(p.x, p.y + 0.36 * number_size, "middle", number,
                      "fill=\"#1b1f24\" stroke=\"none\"");
    }
    return out + "</g>";
  }

  std::string north() const {
    const Vec2d n = axes_.of(options_.north);
    const double l = std::hypot(n.x, n.y);
    if (!(l > 1e-6)) return {};
    const Vec2d d{n.x / l, -n.y / l};
    const double x = width_ - compass / 2, y = margin + 30, r = 20;
    const auto tip = fmt::format("{:.1f},{:.1f}", x + d.x * r, y + d.y * r);
    return "<g stroke=\"#1b1f24\" fill=\"#1b1f24\" stroke-width=\"1\">" +
           fmt::format("<path d=\"M{}L{:.1f},{:.1f}L{:.1f},{:.1f}Z\"/>", tip,
                       x - d.x * 0.6 * r - d.y * 7, y - d.y * 0.6 * r + d.x * 7, x - d.x * 0.25 * r,
                       y - d.y * 0.25 * r) +
           fmt::format("<path fill=\"none\" d=\"M{}L{:.1f},{:.1f}L{:.1f},{:.1f}Z\"/>", tip,
                       x - d.x * 0.6 * r + d.y * 7, y - d.y * 0.6 * r - d.x * 7, x - d.x * 0.25 * r,
                       y - d.y * 0.25 * r) +
           "</g>" + fmt::format("<g font-size=\"{}\" font-weight=\"bold\">", name_size) +
           svg_text(x + d.x * (r + 9), y + d.y * (r + 9) + 0.36 * name_size, "middle", "N") +
           "</g>";
  }

  // Draws a scale bar of a round number of metres, about a fifth of the width.
  std::string bar() const {
    const double wanted = 0.2 * (upper_.x - lower_.x);
    const double power = std::pow(10.0, std::floor(std::log10(std::max(wanted, 0.1))));
    const double part = wanted / power, length = power * (part >= 5 ? 5 : part >= 2 ? 2 : 1);
    const double x = margin, y = height_ - foot + 8;
    return "<g stroke=\"#1b1f24\" stroke-width=\"2\">" + svg_line(x, y, x + length * scale_, y) +
           "</g>" + fmt::format("<g font-size=\"{}\">", name_size) +
           svg_text(x + length * scale_ + 8, y + 4, "start", fmt::format("{:g} m", length)) +
           "</g>";
  }

  const Assessment& a_;
  const Storey& storey_;
  const AssessmentOptions& options_;
  PlanAxes axes_;
  Vec2d lower_{std::numeric_limits<double>::max(), std::numeric_limits<double>::max()},
      upper_{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::lowest()};
  double scale_ = 1, width_ = 0, height_ = 0;
};

}  // namespace

std::vector<Storey> storeys_of(const Assessment& a, const Vec3d& up) {
  constexpr double least = 1.5;  // m
  std::vector<size_t> order(a.floors.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto height = [&](size_t f) { return dot(middle_of(a.floors[f]), up); };
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t x, size_t y) { return height(x) < height(y); });
  std::vector<Storey> storeys;
  for (const size_t f : order) {
    if (storeys.empty() || height(f) > height(storeys.back().floors.back()) + least)
      storeys.push_back({height(f), {}, {}, {}});
    storeys.back().floors.push_back(f);
  }
  if (storeys.empty()) storeys.emplace_back();
  const auto under = [&](const Vec3d& p) -> Storey& {
    size_t s = 0;
    while (s + 1 < storeys.size() && storeys[s + 1].height <= dot(p, up) + 0.1) ++s;
    return storeys[s];
  };
  for (size_t i = 0; i < a.surfaces.size(); ++i)
    under(middle_of(a.surfaces[i].surface)).surfaces.push_back(i);
  for (size_t i = 0; i < a.luminaires.size(); ++i)
    under(a.luminaires[i].position).luminaires.push_back(i);
  return storeys;
}

std::string plan_plot(const Assessment& a, const Storey& storey, const AssessmentOptions& options,
                      double width, double height) {
  return Plan(a, storey, options, width, height).svg();
}

}  // namespace troffer
