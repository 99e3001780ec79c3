#pragma once

#include "fleetmap/config/field_config.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {

/// `field` of a fleet's file.
FieldConfig read_field(Section& top);

}  // namespace fleetmap::config
