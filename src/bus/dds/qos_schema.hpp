#pragma once

#include <string>

#include "fleetmap/core/result.hpp"

namespace tinyxml2 {
class XMLElement;
}

namespace fleetmap::bus {

/// Checks the elements, attributes and values of a profile file against what Fast DDS 2.9 reads. Fast DDS
/// itself drops a profile with an unknown element and goes on; and settings that would change the whole
/// process (library_settings, log, is_default_profile) are refused, since several buses may live in one
/// process. The error says file:line, what is wrong and what was expected.
Status check_schema(const tinyxml2::XMLElement& root, const std::string& file);

}  // namespace fleetmap::bus
