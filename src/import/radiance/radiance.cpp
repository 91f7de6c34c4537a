#include "import/radiance/radiance.h"

#include <filesystem>

#include "import/file.h"
#include "import/radiance/radiance_command.h"
#include "import/radiance/radiance_surface.h"
#include "import/radiance/radiance_view.h"

namespace troffer {

namespace {

// Limit on the bytes of all files together; a file counts each time it is included.
constexpr uint64_t max_radiance_bytes = uint64_t(1) << 30;
constexpr size_t max_open_files = 16;

class RadianceReader {
 public:
  RadianceReader(const std::string& path, Scene& scene, PlacedBounds& bounds)
      : path_(path),
        scene_(scene),
        materials_(scene, folder_of(path)),
        surfaces_(scene, bounds, materials_) {}
  void read();

 private:
  // Transform, modifier and orientation that a file is included with.
  struct Shown {
    Affine world;
    std::string modifier;  // replaces that of all surfaces; "" keeps their own
    bool is_inverted = false;
  };

  std::string path_;
  Scene& scene_;
  RadianceMaterials materials_;
  RadianceSurfaces surfaces_;
  std::map<std::string, std::shared_ptr<const std::string>> texts_;
  std::vector<std::string> views_;
  uint64_t bytes_ = 0;
  size_t open_files_ = 0;

  void read_file(const std::string& path, const Shown& shown, const SourcePlace* from);
  void read_statement(RadianceText& text, const std::string& first, const Shown& shown);
  void run(const std::string& command, const Shown& shown, const SourcePlace& place);
  void show_files(const std::vector<std::string>& names, const std::vector<Shown>& copies,
                  const SourcePlace& place);
  void show_box(const std::vector<std::string>& words, const std::vector<Shown>& copies,
                const SourcePlace& place);
  void read_views();
};

void RadianceReader::read() {
  read_file(path_, Shown(), nullptr);
  surfaces_.finish();
  read_views();
}

void RadianceReader::read_views() {
  for (const std::string& line : views_)
    add_radiance_view(line, "view" + std::to_string(scene_.cameras.size()), scene_);
  if (!scene_.cameras.empty()) return;
  const std::string beside = std::filesystem::path(path_).replace_extension(".vf").string();
  if (std::filesystem::exists(beside)) add_radiance_view_file(beside, scene_);
}

void RadianceReader::read_file(const std::string& path, const Shown& shown,
                               const SourcePlace* from) {
  const SourcePlace top{std::make_shared<const std::string>(path), 0, 0};
  if (open_files_ >= max_open_files)
    (from ? *from : top).fail("files include each other endlessly");
  std::shared_ptr<const std::string>& text = texts_[path];
  if (!text) text = std::make_shared<const std::string>(read_text_file(path, max_radiance_bytes));
  bytes_ += text->size();
  if (bytes_ > max_radiance_bytes)
    (from ? *from : top).fail("the files of this scene are too large");
  ++open_files_;
  const std::shared_ptr<const std::string> kept = text;
  RadianceText words(top.file, *kept);
  while (true) {
    const std::string word = words.first_word();
    if (word.empty()) break;
    read_statement(words, word, shown);
  }
  if (!from) views_ = words.views();
  --open_files_;
}

void RadianceReader::read_statement(RadianceText& text, const std::string& first,
                                    const Shown& shown) {
  RadianceModifier p;
  p.place = text.place();
  p.world = shown.world;
  for (const char c : first)
    if (static_cast<unsigned char>(c) < 32) p.place.fail("this is not a text file");
  if (first == "!") {
    run(text.command(), shown, p.place);
    return;
  }
  p.modifier = first;
  p.type = text.word();
  const std::string name = text.word();
  if (name.empty()) p.place.fail("a modifier, a type and an identifier expected");
  if (p.type == "alias") {
    p.arguments.strings.push_back(text.word());
    if (p.arguments.strings[0].empty()) p.place.fail("alias needs two names");
    materials_.define(name, std::move(p));
    return;
  }
  const bool is_surface = RadianceSurfaces::is_surface(p.type);
  if (!is_surface && !RadianceMaterials::is_modifier(p.type))
    p.place.fail("'" + shortened(p.type) + "' is not a Radiance type");
  p.arguments = text.arguments();
  if (!is_surface) {
    materials_.define(name, std::move(p));
    return;
  }
  if (!shown.modifier.empty()) p.modifier = shown.modifier;
  surfaces_.add(p, name, shown.is_inverted);
}

// Interprets genbox, xform and cat, and pipes of them into xform. Nothing is executed.
void RadianceReader::run(const std::string& command, const Shown& shown, const SourcePlace& place) {
  std::vector<std::vector<std::string>> parts(1);
  for (const std::string& word : words_of(command)) {
    if (word == "|")
      parts.emplace_back();
    else
      parts.back().push_back(word);
  }
  std::vector<Shown> copies{shown};
  for (size_t i = parts.size(); i-- > 0;) {
    std::vector<std::string>& words = parts[i];
    if (words.empty()) place.fail("a command is missing");
    const std::string name = words[0];
    words.erase(words.begin());
    const bool is_first = i == 0;
    if (name == "xform") {
      const RadianceXform xform = parse_xform(words, place);
      if (is_first && xform.files.empty()) place.fail("xform: a file expected");
      if (!is_first && !xform.files.empty()) place.fail("xform: no files expected in a pipe");
      if (copies.size() * xform.copies.size() > 100'000) place.fail("xform: too many copies");
      std::vector<Shown> all;
      for (const Shown& outer : copies)
        for (const Affine& t : xform.copies)
          all.push_back({outer.world * t, outer.modifier.empty() ? xform.modifier : outer.modifier,
                         outer.is_inverted != xform.is_inverted});
      copies = std::move(all);
      if (is_first) show_files(xform.files, copies, place);
    } else if (is_first && name == "cat" && !words.empty()) {
      show_files(words, copies, place);
    } else if (is_first && name == "genbox") {
      show_box(words, copies, place);
    } else {
      scene_.warnings.add("the command \"!" + shortened(name) +
                          "\" is not run: put what it prints into the file");
      return;
    }
  }
}

void RadianceReader::show_files(const std::vector<std::string>& names,
                                const std::vector<Shown>& copies, const SourcePlace& place) {
  std::vector<std::string> paths;
  for (const std::string& name : names) {
    const ConfinedPath path = confined_path(folder_of(path_), name);
    if (!path.is_fine()) place.fail("cannot use '" + shortened(name) + "': " + path.problem);
    paths.push_back(path.path);
  }
  for (const Shown& copy : copies)
    for (const std::string& path : paths) read_file(path, copy, &place);
}

void RadianceReader::show_box(const std::vector<std::string>& words,
                              const std::vector<Shown>& copies, const SourcePlace& place) {
  const RadianceBox box = parse_genbox(words, place);
  if (box.is_simplified) scene_.warnings.add("genbox: edges are left sharp");
  RadianceModifier p;
  p.type = "polygon";
  p.place = place;
  for (const Shown& copy : copies) {
    p.modifier = copy.modifier.empty() ? box.modifier : copy.modifier;
    p.world = copy.world;
    for (const std::vector<Vec3d>& polygon : box.polygons)
      surfaces_.add_polygon(p, words[1], polygon, copy.is_inverted);
  }
}

}  // namespace

Scene import_radiance(const std::string& path) {
  return import_recentred([&](Scene& scene, PlacedBounds& bounds) {
    scene.file = path;
    RadianceReader(path, scene, bounds).read();
  });
}

}  // namespace troffer
