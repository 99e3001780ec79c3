#include "stored_fleet.hpp"

#include <utility>

#include "fleetmap/output/placed_store.hpp"

namespace fleetmap::run_evaluation {

Result<StoredFleet> open_stored(const std::filesystem::path& store_file) {
  auto store = store::Store::open_read_only(store_file);
  if (!store) return tl::unexpected(store.error());
  const auto recipe = output::map_recipe(*store);
  if (!recipe) return failure(store_file.string() + ": no map was made of it yet");
  auto placement = output::place(*store, recipe->origin, recipe->placement);
  auto alignments = output::alignments_of(*store);
  return StoredFleet{std::move(*store), *recipe, std::move(alignments), std::move(placement)};
}

store::MergedMap map_with_sources(StoredFleet& held) {
  return output::main_map(held.store, held.placement, held.recipe.merge);
}

}  // namespace fleetmap::run_evaluation
