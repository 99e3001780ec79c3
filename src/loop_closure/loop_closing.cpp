#include "fleetmap/loop_closure/loop_closing.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "fleetmap/loop_closure/registered_alignment.hpp"
#include "odometry_candidates.hpp"
#include "registration_prior.hpp"
#include "registration_worker.hpp"
#include "session_candidates.hpp"

namespace fleetmap::loop_closure {

LoopClosing::LoopClosing(const LoopClosingConfig& config, bus::Bus& bus, store::Store& store, Outputs outputs)
    : config_(config),
      bus_(bus),
      store_(store),
      outputs_(std::move(outputs)),
      scheduler_(config.self, config.candidates),
      own_path_(std::make_unique<OdometryCandidates>(config.own_path)),
      sessions_(std::make_unique<SessionCandidates>(config.candidates)),
      worker_(std::make_unique<RegistrationWorker>(config.self, config.spherize, config.registration, bus,
                                                   store)) {}

LoopClosing::~LoopClosing() = default;

const RegistrationCounters& LoopClosing::registrations() const { return worker_->counters(); }

bool LoopClosing::idle() const { return worker_->idle(); }

void LoopClosing::begin_session(std::uint16_t session) {
  session_ = session;
  sessions_->begin(store_.nodes_from({config_.self, 0, kEndOfSeqs}));
}

void LoopClosing::on_own_node(const graph::Node& node) {
  if (const auto candidate = sessions_->propose(node)) register_own(*candidate);
  if (!config_.closes_own_path) return;
  if (const auto candidate = own_path_->propose(node)) register_own(*candidate);
}

void LoopClosing::on_returned_node(const graph::Node& node) { sessions_->add_earlier(node); }

void LoopClosing::make_cloud(const graph::Node& node, std::function<void(std::optional<Bytes>)> done) {
  worker_->make_cloud(node, std::move(done));
}

void LoopClosing::register_own(const LoopCandidate& candidate) {
  const graph::Node* target = store_.node(candidate.target);
  const graph::Node* source = store_.node(candidate.source);
  // A node that others returned may still lack its submap.
  if (target == nullptr || source == nullptr || !store_.has_submap(target->id)) return;
  if (const auto prior = registration_prior(candidate, *target, *source, config_.candidates))
    worker_->register_own(*target, *source, *prior, [this](const Registration& done) { conclude(done); });
}

void LoopClosing::register_received() {
  for (const ReceivedCloud& received : scheduler_.take_received()) start(received);
}

void LoopClosing::start(const ReceivedCloud& received) {
  const LoopCandidate& candidate = received.candidate;
  const graph::Node* target = store_.node(candidate.target);
  const graph::Node* source = store_.node(candidate.source);
  if (target == nullptr || source == nullptr) return scheduler_.on_rejected(candidate.pair(), bus_.now());
  const auto prior = registration_prior(candidate, *target, *source, config_.candidates);
  if (!prior) {
    // The peer alone has a prior; it registers the pair too.
    spdlog::info("{}: there is no prior for the pose of {} relative to {}", config_.self.str(),
                 to_string(source->id), to_string(target->id));
    return scheduler_.on_rejected(candidate.pair(), bus_.now());
  }
  const bool started = worker_->register_received(*target, *source, received.cloud, *prior,
                                                  [this](const Registration& done) { conclude(done); });
  if (!started) scheduler_.on_rejected(candidate.pair(), bus_.now());
}

void LoopClosing::conclude(const Registration& registration) {
  outputs_.record(registration);
  using registration::Verdict;
  const graph::Node& i = registration.target;
  const graph::Node& j = registration.source;
  const bool rejected = !registration.result || registration.result->verdict == Verdict::rejected;
  // An ambiguous alignment is sent with all its modes, since other alignments may resolve the ambiguity.
  if (rejected || !outputs_.publish(alignment_of(i.id, j.id, config_.self, *registration.result)))
    return scheduler_.on_rejected({i.id, j.id}, bus_.now());
  // A registration that began before the session does not count for it.
  if (registration.result->verdict == Verdict::accepted && i.id.agent == j.id.agent &&
      i.session != session_ && j.session == session_)
    sessions_->on_accepted(i, j);
  outputs_.published();
}

}  // namespace fleetmap::loop_closure
