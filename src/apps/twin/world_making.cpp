#include "world_making.hpp"

#include "fleetmap/config/world_file.hpp"
#include "world_files.hpp"

namespace fleetmap::apps {

CommandResult<ExitCode> make_world(const WorldOptions& options, std::ostream& out) {
  const auto spec = config::load_world(options.file);
  if (!spec) return exit_with(kBadConfiguration, spec.error());
  const auto world = config::make_world(options.file, options.seed);
  if (!world) return exit_with(kBadConfiguration, world.error());
  describe_world(out, **world);
  if (options.out.empty()) return kDone;
  WorldFileOptions settings = options.files;
  settings.seed = options.seed.value_or(settings.seed);
  const Status written = write_world(out, **world, options.out, settings);
  return written ? CommandResult<ExitCode>(kDone) : exit_with(kFailed, written.error());
}

}  // namespace fleetmap::apps
