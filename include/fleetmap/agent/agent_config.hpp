#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "fleetmap/agent/live_placement_config.hpp"
#include "fleetmap/agent/perception.hpp"
#include "fleetmap/agent/submap_builder.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/exchange/exchange.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/graph/compute_placement.hpp"
#include "fleetmap/loop_closure/candidate_config.hpp"
#include "fleetmap/loop_closure/own_path_config.hpp"
#include "fleetmap/output/results.hpp"
#include "fleetmap/place/node_generator.hpp"
#include "fleetmap/registration/register_clouds.hpp"
#include "fleetmap/registration/spherize.hpp"
#include "fleetmap/store/map_merge.hpp"
#include "fleetmap/store/registration_log_config.hpp"
#include "fleetmap/store/sessions.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::agent {

struct NavigatorConfig;  // navigator_config.hpp

/// Everything that can be set of one robot, by component.
struct AgentConfig {
  AgentId id;
  std::filesystem::path directory;      ///< for store.db, trajectories, maps
  std::optional<GeoPoint> site_origin;  ///< of ENU; absent: the position of the least node id held
  PerceptionConfig perception;
  place::NodeGeneratorConfig nodes;
  loop_closure::CandidateConfig loop_closure;
  /// With placement.method graph alone: the paper's placement has no use for loops of one robot.
  loop_closure::OwnPathConfig own_path;
  SubmapConfig submap;
  registration::SpherizeConfig spherize;
  registration::RegistrationConfig registration;
  exchange::ExchangeConfig exchange;  ///< payload_size, clouds.order and clouds.cancel_when_aligned are
                                      ///< filled in by the agent
  graph::PlacementConfig placement;
  LivePlacementConfig live_placement;
  store::StoreConfig store;
  store::RegistrationLogConfig registration_log;
  store::MergeConfig map;
  store::Sessions::Draw draw_session = store::random_session;
  std::shared_ptr<const NavigatorConfig> navigator;  ///< absent: the robot is driven by others

  /// The rules by which maps are made, and the rest that results depend on.
  output::RecipeConfig recipe() const {
    return {site_origin, placement, map, loop_closure.proximity.max_radius};
  }
  output::ResultsConfig results() const { return {id, directory, recipe()}; }
  /// Names the component, the field and the rule that it breaks.
  Status validate() const;
};

}  // namespace fleetmap::agent
