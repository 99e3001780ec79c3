#pragma once

#include <string>

#include "fleetmap/agent/agent_config.hpp"
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

/// An agent's configuration that was read from a section, and the problems that were noted.
struct AgentReading {
  agent::AgentConfig agent;
  std::string problems;
};

template <class Read>
AgentReading agent_of(const std::string& yaml, Read read) {
  AgentReading reading;
  reading.problems = problems_of(yaml, [&](Section& top) { read(top, reading.agent); });
  return reading;
}

}  // namespace fleetmap::config
