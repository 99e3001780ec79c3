#include "http_message.hpp"

#include <algorithm>

namespace fleetmap::monitor {

std::string_view HttpResponse::header(std::string_view name) const {
  const auto found = std::ranges::find(headers, name, &std::pair<std::string, std::string>::first);
  return found == headers.end() ? std::string_view() : std::string_view(found->second);
}

}  // namespace fleetmap::monitor
