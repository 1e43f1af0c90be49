// SPDX-License-Identifier: GPL-3.0-or-later
// 3MF packages and binary glTF files around the scenes that tests write.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/archive.h"

namespace binderjet {

struct Package3mf {
  std::string resources;  // XML; `m:` is the materials' namespace
  std::string build;
  std::string unit = "millimeter";
  std::string model = "3D/3dmodel.model";  // the entry's name
  std::string image = "";                  // a texture's place in the package, from "/" on
  std::string image_bytes = "";            // empty: the package does not hold it
};

inline std::string package_3mf(const Package3mf& package) {
  const std::string xml = R"(<?xml version="1.0"?>)";
  const auto relation = [&](const std::string& target, const std::string& kind) {
    return xml +
           R"(<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">)"
           R"(<Relationship Id="r" Target=")" +
           target + R"(" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/)" + kind +
           R"("/></Relationships>)";
  };
  std::vector<std::pair<std::string, std::string>> entries = {
      {"[Content_Types].xml",
       xml + R"(<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
         <Default Extension="rels"
           ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
         <Default Extension="model"
           ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
         <Default Extension="png" ContentType="image/png"/>
         <Default Extension="jpg" ContentType="image/jpeg"/></Types>)"},
      {"_rels/.rels", relation("/" + package.model, "3dmodel")},
      {package.model,
       xml + R"(<model xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
         xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02" unit=")" +
           package.unit + "\"><resources>" + package.resources + "</resources><build>" +
           package.build + "</build></model>"}};
  if (!package.image.empty()) {
    entries.emplace_back("3D/_rels/3dmodel.model.rels", relation(package.image, "3dtexture"));
  }
  if (!package.image_bytes.empty()) {
    entries.emplace_back(package.image.substr(1), package.image_bytes);
  }
  return archive_bytes(entries);
}

// The bytes of the values one after the other, as this machine has them: little-endian.
template <typename T>
std::string raw_bytes(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

// The JSON's only buffer, if it has one, is `data`; the file pads it to four bytes.
inline std::string glb_file(std::string json, std::string data) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  data.resize((data.size() + 3) / 4 * 4, '\0');
  const auto size = [](std::size_t bytes) {
    return raw_bytes<std::uint32_t>({static_cast<std::uint32_t>(bytes)});
  };
  return "glTF" + size(2) + size(28 + json.size() + data.size()) + size(json.size()) + "JSON" +
         json + size(data.size()) + std::string("BIN\0", 4) + data;
}

}  // namespace binderjet
