#include "ros_names.hpp"

namespace fleetmap::recording {

std::string ros_topic(std::string_view topic) {
  if (topic.starts_with("rt/")) return std::string(topic.substr(2));
  std::string name(topic);
  if (!name.starts_with('/')) name.insert(name.begin(), '/');
  return name;
}

std::string ros_type(std::string_view type) {
  std::string name(type);
  const bool dds = name.find("::dds_::") != std::string::npos;
  if (dds) name.erase(name.find("::dds_"), 6);
  if (dds && name.ends_with('_')) name.pop_back();
  for (std::size_t at = name.find("::"); at != std::string::npos; at = name.find("::", at))
    name.replace(at, 2, 1, '/');
  return name;
}

}  // namespace fleetmap::recording
