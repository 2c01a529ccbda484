// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/xml_file.h"

#include "engine/base/error.h"
#include "engine/files/text_file.h"

#include <string_view>

#include <fmt/format.h>
#include <tinyxml2.h>

namespace gpo {
namespace {

using tinyxml2::XMLElement;

YAML::Node words_of(const XMLElement& element) {
  std::string_view text = element.GetText() != nullptr ? element.GetText() : "";
  text = trimmed(text);
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
    return YAML::Node(std::string(text.substr(1, text.size() - 2)));
  }
  YAML::Node words(YAML::NodeType::Sequence);
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find_first_of(" \t\r\n"));
    words.push_back(std::string(word));
    text = trimmed(text.substr(word.size()));
  }
  if (words.size() > 1) return words;
  return words.size() == 1 ? YAML::Node(words[0].Scalar()) : YAML::Node();
}

/// What nests deeper than any calibration is passed over: yaml-cpp takes the time of all values
/// again at each level.
YAML::Node node_of(const XMLElement& element, int depth = 0) {
  constexpr int kDeepest = 16;
  const XMLElement* child = element.FirstChildElement();
  if (child == nullptr || depth == kDeepest) return words_of(element);
  YAML::Node node;
  for (; child != nullptr; child = child->NextSiblingElement()) {
    const std::string name = child->Name();
    if (name == "_") {
      if (node.IsMap()) continue;
      node.push_back(node_of(*child, depth + 1));
    } else if (!node.IsSequence()) {
      node.force_insert(name, node_of(*child, depth + 1));
    }
  }
  return node;
}

}  // namespace

bool is_xml(const std::filesystem::path& file) {
  const std::string content = read_file(file, kMostBytesByHand);
  std::string_view text = content;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
  return trimmed(text).starts_with('<');
}

YamlEntry load_opencv_xml(const std::filesystem::path& file) {
  const std::string text = read_file(file, kMostBytesByHand);
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());
  const XMLElement* root = document.RootElement();
  if (document.Error() || root == nullptr) {
    throw InputError(fmt::format("{}:{}: found {}, expected XML",
                                 file.string(),
                                 document.ErrorLineNum(),
                                 document.Error() ? document.ErrorName() : "no element"));
  }
  return {file, "", node_of(*root)};
}

}  // namespace gpo
