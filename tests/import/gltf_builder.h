// Small glTF documents for tests.
#pragma once

#include <doctest/doctest.h>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "base/error.h"
#include "import/gltf/gltf.h"
#include "import/scene_checks.h"
#include "import/temp_folder.h"

namespace troffer {

// Returns the bytes of the values in sequence.
template <class T>
std::string bytes_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

inline std::string base64(const std::string& bytes) {
  const char* const alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t bits = 0;
    for (size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? uint32_t(uint8_t(bytes[i + k])) : 0u);
    for (size_t k = 0; k < 4; ++k)
      out += i + k > bytes.size() ? '=' : alphabet[(bits >> (18 - 6 * k)) & 63];
  }
  return out;
}

// Returns a document from members of the top-level object, with every ' replaced by ".
inline std::string gltf_text(std::string members) {
  std::string text =
      "{'asset':{'version':'2.0'}" + std::string(members.empty() ? "" : ",\n") + members + "}";
  for (char& c : text)
    if (c == '\'') c = '"';
  return text;
}

inline std::string data_buffer(const std::string& bytes) {
  return "{'byteLength':" + std::to_string(bytes.size()) +
         ",'uri':'data:application/octet-stream;base64," + base64(bytes) + "'}";
}

// Imports a document from a file of its own.
inline Scene import_text(const std::string& text) {
  const TempFolder folder;
  return import_gltf(folder.write("scene.gltf", text));
}

// Returns the error that importing the document gives. Fails the test if there is none.
inline InputError error_of(const std::string& text) {
  try {
    import_text(text);
  } catch (const InputError& e) {
    return e;
  }
  FAIL("no error");
  return InputError("", 0, 0, "");
}

// Returns the unit square in the plane z = 0, front to +z, as buffer 0: 4 float positions, 6 u16
// indices (two triangles), 4 float normals (+z), 4 float uvs. They are accessors 0 to 3 in that
// order.
inline std::string square_bytes() {
  return bytes_of<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) +
         bytes_of<uint16_t>({0, 1, 2, 0, 2, 3}) +
         bytes_of<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}) +
         bytes_of<float>({0, 1, 1, 1, 1, 0, 0, 0});
}
inline std::string square_data() {
  return "'buffers':[" + data_buffer(square_bytes()) +
         "],\n'bufferViews':[{'buffer':0,'byteLength':48},"
         "{'buffer':0,'byteOffset':48,'byteLength':12},"
         "{'buffer':0,'byteOffset':60,'byteLength':48},"
         "{'buffer':0,'byteOffset':108,'byteLength':32}],\n"
         "'accessors':[{'bufferView':0,'componentType':5126,'count':4,'type':'VEC3'},"
         "{'bufferView':1,'componentType':5123,'count':6,'type':'SCALAR'},"
         "{'bufferView':2,'componentType':5126,'count':4,'type':'VEC3'},"
         "{'bufferView':3,'componentType':5126,'count':4,'type':'VEC2'}]";
}
// Returns a document with the square as mesh 0 and material 0 (which `more` must define), shown by
// `nodes`.
inline std::string square_scene(const std::string& nodes, const std::string& more) {
  return gltf_text(square_data() +
                   ",\n'meshes':[{'primitives':[{'attributes':{'POSITION':0,'NORMAL':2,"
                   "'TEXCOORD_0':3},'indices':1,'material':0}]}],\n'nodes':" +
                   nodes + ",\n" + more);
}

}  // namespace troffer
