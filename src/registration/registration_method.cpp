#include "fleetmap/registration/registration_method.hpp"

#include <string>

namespace fleetmap::registration {

Result<Method> registration_method(std::string_view name) {
  for (const Method method : {Method::correlation, Method::paper}) {
    if (name == to_string(method)) return method;
  }
  return failure("expected 'paper' or 'correlation', found '" + std::string(name) + "'");
}

bool uses_prior(Method method) { return method == Method::correlation; }

}  // namespace fleetmap::registration
