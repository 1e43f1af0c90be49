// SPDX-License-Identifier: GPL-3.0-or-later
// XML as libxml2 reads it: elements by their namespace and name.
#pragma once

#include <gtest/gtest.h>
#include <libxml/parser.h>
#include <libxml/tree.h>

#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace binderjet {

class XmlElement {
 public:
  explicit XmlElement(xmlNode* node) : node_(node) {}

  std::string name() const { return text(node_->name); }
  std::string space() const { return node_->ns == nullptr ? "" : text(node_->ns->href); }
  std::string text() const {
    const std::unique_ptr<xmlChar, void (*)(void*)> value(xmlNodeGetContent(node_), xmlFree);
    return text(value.get());
  }
  std::optional<std::string> attribute(const std::string& key) const {
    const std::unique_ptr<xmlChar, void (*)(void*)> value(
        xmlGetNoNsProp(node_, reinterpret_cast<const xmlChar*>(key.c_str())), xmlFree);
    return value ? std::optional(text(value.get())) : std::nullopt;
  }
  // The attribute, which must be there.
  std::string operator[](const std::string& key) const {
    const auto value = attribute(key);
    EXPECT_TRUE(value) << name() << " lacks " << key;
    return value.value_or("");
  }
  int number(const std::string& key) const { return std::atoi((*this)[key].c_str()); }
  // The namespace that a prefix stands for here.
  std::string prefix(const std::string& name) const {
    const xmlNs* space =
        xmlSearchNs(node_->doc, node_, reinterpret_cast<const xmlChar*>(name.c_str()));
    return space == nullptr ? "" : text(space->href);
  }
  std::vector<XmlElement> children(const std::string& only = "") const {
    std::vector<XmlElement> all;
    for (xmlNode* child = xmlFirstElementChild(node_); child != nullptr;
         child = xmlNextElementSibling(child)) {
      if (only.empty() || text(child->name) == only) all.emplace_back(child);
    }
    return all;
  }
  // The one child of this name.
  XmlElement child(const std::string& name) const {
    const std::vector<XmlElement> all = children(name);
    EXPECT_EQ(all.size(), 1) << name << " in " << this->name();
    return all.empty() ? *this : all.front();
  }

 private:
  static std::string text(const xmlChar* chars) { return reinterpret_cast<const char*>(chars); }

  xmlNode* node_;
};

class Xml {
 public:
  explicit Xml(const std::string& text)
      : document_(xmlReadMemory(text.data(), static_cast<int>(text.size()), nullptr, nullptr,
                                XML_PARSE_NONET),
                  xmlFreeDoc) {
    EXPECT_TRUE(document_) << "not well formed";
  }
  XmlElement root() const { return XmlElement(xmlDocGetRootElement(document_.get())); }

 private:
  std::unique_ptr<xmlDoc, void (*)(xmlDocPtr)> document_;
};

}  // namespace binderjet
