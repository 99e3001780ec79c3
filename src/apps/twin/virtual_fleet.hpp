#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fleet_feed.hpp"
#include "fleetmap/agent/agent.hpp"
#include "fleetmap/bus/local_network.hpp"
#include "fleetmap/config/fleet_config.hpp"
#include "fleetmap/monitor/preview_writer.hpp"
#include "fleetmap/output/map_files.hpp"
#include "fleetmap/output/results.hpp"
#include "fleetmap/recording/bag_writer.hpp"
#include "page/virtual_page.hpp"
#include "robot/output_recording.hpp"
#include "robot/record_options.hpp"

namespace fleetmap::apps {

/// When the mission's ends were reached, s from the start of the run; empty: never.
struct Completion {
  std::optional<double> rows_driven;  ///< every row of the mission
  std::optional<double> aligned;      ///< every agent joined to the fleet by alignments with E <= 0.4
  std::optional<double> completed;    ///< both, and all nodes shared: the paper's end of mapping
  std::string why_not;                ///< not completed
  struct Abandoned {
    planning::RowId row = 0;
    AgentId agent;    ///< gave it up
    std::string why;  ///< empty: no robot was left to drive it
  };
  std::vector<Abandoned> abandoned;  ///< rows that were not driven to their ends, at the end of the run
  std::optional<double> lane_share;  ///< of the twin's lanes, truly driven
};

/// Result of a run in virtual time.
struct FleetOutcome {
  struct AgentOutcome {
    AgentId id;
    std::filesystem::path directory;
    std::unique_ptr<agent::Agent> agent;  ///< null: it was switched off to the end, `store` is what it left
    std::optional<store::Store> store;
    std::optional<output::Results> results;
    recording::Counters recording;
    std::vector<std::string> recording_findings;  ///< of its reader
    std::string problem;  ///< why there are no results, or why they are not of the whole recording
  };
  std::vector<AgentOutcome> agents;
  std::vector<bus::LinkUse> links;
  GeoPoint origin;
  bool origin_known = false;
  Duration virtual_time{};               ///< from the first sensor sample to the end of the exchange
  Duration exchange_time{};              ///< of it, after the last sensor sample
  bool exchange_ended = false;           ///< the exchange came to its end by itself
  std::optional<Completion> completion;  ///< of a mission
  FeedSeconds feed_seconds;              ///< CPU
  agent::WorkSeconds work_seconds;       ///< CPU, of all agents
  double results_seconds = 0.0;          ///< CPU of the final placements and maps
};

/// A whole fleet in one process, in virtual time: each member's samples come from a feed onto its bus.
class VirtualFleet {
 public:
  /// Agents keep their files in `out`/<id>, which must not hold an earlier run. With `record`, what each
  /// agent's sensors gave and it published goes to a bag in `record.folder`/<id>. Sessions are numbered from
  /// `first_session`.
  static Result<std::unique_ptr<VirtualFleet>> create(config::FleetConfig config,
                                                      std::unique_ptr<FleetFeed> feed,
                                                      const std::filesystem::path& out,
                                                      const RecordOptions& record,
                                                      std::uint16_t first_session = 0);

  /// Publishes the fleet's live status there while it runs; `server` outlives this.
  void show_on(monitor::Server& server) { page_ = std::make_unique<VirtualPage>(*network_, server); }
  /// Adds the submaps of the robots' maps to `previews`, which outlives this.
  void keep_previews_in(monitor::PreviewWriter& previews) { previews_ = &previews; }
  /// Plays everything, lets the exchange end and writes every agent's results.
  Result<FleetOutcome> run();

 private:
  struct Member {
    AgentId id;
    bus::Bus* bus = nullptr;              ///< null while it is switched off
    std::unique_ptr<agent::Agent> agent;  ///< null while it is switched off
    std::optional<recording::BagWriter> bag;
    Duration bag_delay{};                      ///< from the bag's time to the network's
    std::unique_ptr<OutputRecording> outputs;  ///< into the bag
    std::vector<bus::Handle> base;             ///< its commands and its guide
    std::optional<bus::EnuPosition> position;  ///< the last known one
    bool rest_frozen = false;
    agent::WorkSeconds work_before;  ///< of agents that were switched off
    bool lost = false;               ///< switched off, and stays so
  };
  VirtualFleet(config::FleetConfig config, std::unique_ptr<FleetFeed> feed)
      : config_(std::move(config)), feed_(std::move(feed)), origin_(feed_->origin()) {}
  Status add_agents(const std::filesystem::path& out, const RecordOptions& record,
                    std::uint16_t first_session);
  /// Starts the member's agent on a bus of its own. It continues from its store.
  Status start_agent(std::size_t member);
  /// Writes to the member's bag, if it has one.
  void record(std::size_t member, const bus::Topic& topic, const Bytes& cdr);
  /// Passes the agent's commands to the feed, and the guide's poses to the agent.
  void connect_base(std::size_t member);
  void schedule_power();
  void schedule_blackouts();
  /// Stops the agent as if its process were killed: no last node, no message.
  void switch_off(std::size_t member, bool for_ever);
  void switch_on(std::size_t member);
  Status begin();
  void deliver(std::size_t member, const recording::Sample& sample, Stamp stamp);
  void update_page();
  /// Passes the robots' positions and batteries to the network and the agents once a second.
  void update_states();
  /// By the feed, else by its own G.
  std::optional<bus::EnuPosition> position_of(std::size_t member) const;
  bool playing() const;
  bool has_mission() const;
  std::vector<Completion::Abandoned> abandoned_rows() const;
  /// Ends the mission in the feed when no robot has anything left to drive, or time is up.
  void end_mission(Duration elapsed);
  bool all_driven() const;
  void note_completion(Duration elapsed);
  bool exchange_ended();
  void report_progress(Duration elapsed) const;
  Result<output::Results> write_results_of(store::Store& store, const output::ResultsConfig& config);
  Result<FleetOutcome::AgentOutcome> finish(std::size_t member);
  /// Outcome of a member that is switched off at the end.
  FleetOutcome::AgentOutcome results_of_store(std::size_t member);

  config::FleetConfig config_;
  std::unique_ptr<FleetFeed> feed_;
  std::optional<GeoPoint> origin_;
  std::unique_ptr<bus::LocalNetwork> network_;
  std::unique_ptr<VirtualPage> page_;           ///< null without one
  monitor::PreviewWriter* previews_ = nullptr;  ///< null without
  std::vector<Member> members_;
  std::optional<Completion> completion_;
  std::vector<output::MapFiles> maps_;  ///< written so far
  double results_seconds_ = 0.0;        ///< CPU
  bool mission_ended_ = false;
  std::string error_;
};

}  // namespace fleetmap::apps
