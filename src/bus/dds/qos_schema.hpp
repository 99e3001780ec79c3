#pragma once

#include <string>

#include "fleetmap/core/result.hpp"

namespace tinyxml2 {
class XMLElement;
}

namespace fleetmap::bus {

/// Checks the elements, attributes and values of a profile file against those that Fast DDS 2.9 reads. Fast
/// DDS itself drops a profile with an unknown element and goes on; and settings that would change the whole
/// process (library_settings, log, is_default_profile) are refused, since several buses may live in one
/// process. The error names file:line, the problem and the expectation.
///
/// A table of our own on tinyxml2, which Fast DDS links anyway: Debian's Fast DDS 2.9.1 installs no XSD, so
/// libxml2 would be one more dependency for a schema that is written by hand just the same.
Status check_schema(const tinyxml2::XMLElement& root, const std::string& file);

}  // namespace fleetmap::bus
