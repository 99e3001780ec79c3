#pragma once

#include <string>

#include "yaml_document.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// Problems of `yaml`, a file robot.yaml, that `read(top)` notes: a line for each, empty if there is none.
template <class Read>
std::string problems_of(const std::string& yaml, Read read) {
  Document document = Document::from(YAML::Load(yaml), "robot.yaml");
  Section top(document, document.root(), "");
  read(top);
  const Status status = document.status();
  return status ? "" : status.error().message;
}

}  // namespace fleetmap::config
