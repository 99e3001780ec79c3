#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "fleetmap/bus/bus.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/loop_closure/registration_record.hpp"
#include "fleetmap/registration/register_clouds.hpp"
#include "fleetmap/registration/spherize.hpp"
#include "fleetmap/store/store.hpp"
#include "own_clouds.hpp"

namespace fleetmap::loop_closure {

/// Makes and registers clouds in the bus's background lane, one job after the other (Alg. 3).
class RegistrationWorker {
 public:
  using OnRegistered = std::function<void(const Registration&)>;
  /// The encoded cloud, nothing if there is none.
  using OnCloud = std::function<void(std::optional<Bytes>)>;

  /// `bus` and `store` outlive this, and this outlives its jobs.
  RegistrationWorker(const AgentId& self, const registration::SpherizeConfig& spherize,
                     const registration::RegistrationConfig& registration, bus::Bus& bus,
                     store::Store& store);

  /// Registers two nodes of this robot. False: too many jobs wait, and `done` is not called.
  bool register_own(const graph::Node& target, const graph::Node& source, const registration::Prior& prior,
                    OnRegistered done);
  /// Registers the received cloud of `source` with that of our `target`; likewise.
  bool register_received(const graph::Node& target, const graph::Node& source, Bytes cloud,
                         const registration::Prior& prior, OnRegistered done);
  /// Makes the cloud around our `node` as peers receive it. `done` is called in any case.
  void make_cloud(const graph::Node& node, OnCloud done);

  bool idle() const { return jobs_ == 0; }
  const RegistrationCounters& counters() const { return counters_; }

 private:
  struct Job;
  struct Source;
  bool start(std::shared_ptr<Job> job, OnRegistered done);
  void run(Job& job) const;
  Result<Source> source_of(Job& job) const;
  void count(const Registration& registration);
  void note_refused_job();
  std::optional<Bytes> encoded(OwnCloud& cloud);

  AgentId self_;
  registration::SpherizeConfig spherize_;
  registration::RegistrationConfig registration_;
  bus::Bus& bus_;
  store::Store& store_;
  OwnClouds own_clouds_;
  std::size_t jobs_ = 0;  ///< under way
  RegistrationCounters counters_;
};

}  // namespace fleetmap::loop_closure
