#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "merged_store.hpp"

namespace fleetmap::apps {

/// Prints what each of `files` added to the merged store, whether each two of them were joined, and what the
/// whole, which is in the file `written`, holds. Rejections that differ in their numbers alone are one line,
/// unless `verbose`.
void print_summary(std::ostream& out, const MergedStore& merged, const std::vector<std::string>& files,
                   const std::string& written, bool verbose);

}  // namespace fleetmap::apps
