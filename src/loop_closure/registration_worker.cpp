#include "registration_worker.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/loop_closure/submap_drift.hpp"

namespace fleetmap::loop_closure {
namespace {

store::LoggedPrior logged(const registration::Prior& prior) {
  return {prior.T_target_source, prior.sigma_translation_m, prior.sigma_yaw_rad,
          prior.sigma_tilt_rad,  prior.sigma_height_m,      prior.up_target};
}

}  // namespace

struct RegistrationWorker::Job {
  std::shared_ptr<OwnCloud> target;
  std::shared_ptr<OwnCloud> own_source;  ///< of an own source; else its cloud was received
  Bytes received;
  registration::Prior prior;
  registration::Drifts drifts;
  Registration registration;
};

/// The cloud of a job's source.
struct RegistrationWorker::Source {
  registration::PreparedCloud prepared;
  Bytes encoded;
};

RegistrationWorker::RegistrationWorker(const AgentId& self, const registration::SpherizeConfig& spherize,
                                       const registration::RegistrationConfig& registration, bus::Bus& bus,
                                       store::Store& store)
    : self_(self),
      spherize_(spherize),
      registration_(registration),
      bus_(bus),
      store_(store),
      own_clouds_(spherize) {}

bool RegistrationWorker::register_own(const graph::Node& target, const graph::Node& source,
                                      const registration::Prior& prior, OnRegistered done) {
  auto job = std::make_shared<Job>();
  job->target = own_clouds_.of(store_, target);
  job->own_source = own_clouds_.of(store_, source);
  job->registration.target = job->target->node();
  job->registration.source = job->own_source->node();
  job->prior = prior;
  return start(std::move(job), std::move(done));
}

bool RegistrationWorker::register_received(const graph::Node& target, const graph::Node& source, Bytes cloud,
                                           const registration::Prior& prior, OnRegistered done) {
  auto job = std::make_shared<Job>();
  job->target = own_clouds_.of(store_, target);
  job->received = std::move(cloud);
  job->registration.target = job->target->node();
  job->registration.source = source;
  job->prior = prior;
  return start(std::move(job), std::move(done));
}

bool RegistrationWorker::start(std::shared_ptr<Job> job, OnRegistered done) {
  job->drifts = {drift_around(store_, job->registration.target, spherize_.radius_m),
                 drift_around(store_, job->registration.source, spherize_.radius_m)};
  ++jobs_;
  const bool taken = bus_.offload(bus::Lane::kBackground, {"registration", [this, job] { run(*job); }},
                                  [this, job, done = std::move(done)] {
                                    --jobs_;
                                    job->registration.done = bus_.now();
                                    count(job->registration);
                                    done(job->registration);
                                  });
  if (!taken) note_refused_job();
  return taken;
}

void RegistrationWorker::run(Job& job) const {
  Registration& registration = job.registration;
  const CpuTimer all(registration.cpu_seconds);
  {
    const CpuTimer timer(registration.spherize_seconds);
    job.target->spherized();
    if (job.own_source) job.own_source->spherized();
  }
  auto source = source_of(job);
  if (!source) {
    registration.result = tl::unexpected(source.error());
    return;
  }
  const auto target = job.target->prepared(registration_);
  if (!target) {
    registration.result = tl::unexpected(target.error());
    return;
  }
  registration.input = {registration.target.id,
                        registration.source.id,
                        registration::to_string(registration_.method),
                        job.target->spherized()->bytes,
                        std::move(source->encoded),
                        logged(job.prior)};
  registration.result =
      registration::register_clouds(*target, source->prepared, registration_, job.prior, job.drifts);
}

Result<RegistrationWorker::Source> RegistrationWorker::source_of(Job& job) const {
  if (job.own_source) {
    auto prepared = job.own_source->prepared(registration_);
    if (!prepared) return tl::unexpected(prepared.error());
    return Source{std::move(*prepared), job.own_source->spherized()->bytes};
  }
  const graph::Node& node = job.registration.source;
  auto message = fleet_codec::decode<messages::SpherizedCloud>(job.received);
  if (!message) return tl::unexpected(message.error());
  if (message->node != node.id) return failure("the cloud is of node " + to_string(message->node));
  const auto cloud = cloud::decode(message->payload);
  if (!cloud) return tl::unexpected(cloud.error());
  return Source{registration::PreparedCloud(*cloud, node.up_in_base, registration_),
                std::move(message->payload)};
}

void RegistrationWorker::count(const Registration& registration) {
  counters_.registration_seconds += registration.cpu_seconds - registration.spherize_seconds;
  counters_.spherization_seconds += registration.spherize_seconds;
  if (!registration.result) {
    ++counters_.failed;
    return;
  }
  using registration::Verdict;
  const Verdict verdict = registration.result->verdict;
  ++(verdict == Verdict::accepted    ? counters_.accepted
     : verdict == Verdict::ambiguous ? counters_.ambiguous
                                     : counters_.rejected);
}

void RegistrationWorker::note_refused_job() {
  --jobs_;
  ++counters_.failed;
  spdlog::warn("{}: {} jobs wait already; one was dropped", self_.str(), bus::Bus::kMaxWork);
}

void RegistrationWorker::make_cloud(const graph::Node& node, OnCloud done) {
  struct CloudJob {
    std::shared_ptr<OwnCloud> cloud;
    double cpu_seconds = 0.0;
  };
  auto job = std::make_shared<CloudJob>(CloudJob{own_clouds_.of(store_, node)});
  ++jobs_;
  const bool taken = bus_.offload(bus::Lane::kBackground,
                                  {"spherization",
                                   [job] {
                                     const CpuTimer timer(job->cpu_seconds);
                                     job->cloud->spherized();
                                   }},
                                  [this, job, done] {
                                    --jobs_;
                                    counters_.spherization_seconds += job->cpu_seconds;
                                    done(encoded(*job->cloud));
                                  });
  if (taken) return;
  note_refused_job();
  done(std::nullopt);
}

std::optional<Bytes> RegistrationWorker::encoded(OwnCloud& own) {
  const NodeId id = own.node().id;
  const auto& cloud = own.spherized();
  if (!cloud) {
    ++counters_.failed;
    spdlog::warn("{}: no spherized cloud: {}", to_string(id), cloud.error().message);
    return std::nullopt;
  }
  ++counters_.clouds_made;
  counters_.largest_cloud_bytes = std::max(counters_.largest_cloud_bytes, cloud->bytes.size());
  return fleet_codec::encode(messages::SpherizedCloud{
      id, spherize_.radius_m, cloud->voxel_m, static_cast<std::uint32_t>(cloud->encoded), cloud->bytes});
}

}  // namespace fleetmap::loop_closure
