#include "server/rpc/metrics.h"

#include "proto/status_name.h"
#include "server/access/front_door.h"
#include "server/archive/record_codec.h"
#include "server/base/cpu_time.h"
#include "server/base/memory_guard.h"
#include "server/rpc/call_counts.h"
#include "server/solves/solve_store.h"
#include "server/solves/solving_ranks.h"
#include "server/watch/watches.h"

#include <prometheus/metric_family.h>

#include <algorithm>

namespace alvor {

namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;

MetricFamily family(const char* name, const char* help, MetricType type) {
  MetricFamily made;
  made.name = name;
  made.help = help;
  made.type = type;
  return made;
}

void add(MetricFamily& to, double value, std::vector<ClientMetric::Label> labels = {}) {
  ClientMetric metric;
  metric.label = std::move(labels);
  if (to.type == MetricType::Counter) metric.counter.value = value;
  else metric.gauge.value = value;
  to.metric.push_back(std::move(metric));
}

MetricFamily one(const char* name, const char* help, MetricType type, double value) {
  MetricFamily made = family(name, help, type);
  add(made, value);
  return made;
}

// The step that metrics count for a solve that has published none.
constexpr Step nothing_known{.unshot_fraction = 0, .estimated_error = 0};

}  // namespace

std::vector<MetricFamily> Metrics::Collect() const {
  std::vector<MetricFamily> all;
  const auto gauge = [&](const char* name, const char* help, double value) {
    all.push_back(one(name, help, MetricType::Gauge, value));
  };
  const auto counter = [&](const char* name, const char* help, double value) {
    all.push_back(one(name, help, MetricType::Counter, value));
  };
  collect_solves(all);
  gauge("alvor_scenes", "Scenes that are stored.", static_cast<double>(scenes_.count()));
  const Watches::Traffic traffic = watches_.traffic();
  gauge("alvor_watchers", "Watches that are open.", static_cast<double>(traffic.watchers));
  gauge("alvor_watcher_lag_revisions", "Revisions that the watcher furthest behind has not acknowledged.",
        static_cast<double>(traffic.most_behind));
  counter("alvor_frames_total", "Frames that were written.", static_cast<double>(traffic.frames));
  counter("alvor_frame_bytes_total", "Bytes of these frames.", static_cast<double>(traffic.bytes));
  MetricFamily calls = family("alvor_calls_total", "Calls that were answered.", MetricType::Counter);
  for (const auto& [call, times] : calls_.counts())
    add(calls, static_cast<double>(times), {{"method", call.first}, {"code", name_of(call.second)}});
  all.push_back(std::move(calls));
  counter("alvor_checkpoints_total", "Checkpoints that were kept.", static_cast<double>(keeping_.checkpoints));
  counter("alvor_checkpoint_seconds_total", "Time that solves waited for these.",
          1e-6 * static_cast<double>(keeping_.microseconds));
  counter("alvor_checkpoint_bytes_total", "Bytes of these.", static_cast<double>(keeping_.bytes));
  counter("alvor_checkpoint_failures_total", "Checkpoints that could not be kept.", static_cast<double>(keeping_.failures));
  gauge("process_resident_memory_bytes", "Memory that is in use.", static_cast<double>(resident_bytes()));
  gauge("alvor_memory_limit_bytes", "Memory that may be in use; 0 is no limit.", static_cast<double>(memory_.limit()));
  counter("process_cpu_seconds_total", "Processor time.", cpu_seconds());
  return all;
}

void Metrics::collect_solves(std::vector<MetricFamily>& families) const {
  std::map<SolveStatus, int> count;
  for (const SolveStatus status : all_statuses) count[status] = 0;
  MetricFamily leaves = family("alvor_solve_leaves", "Leaves of a running solve.", MetricType::Gauge);
  MetricFamily unshot =
      family("alvor_solve_unshot_fraction", "Unshot power of a running solve, of the emitted.", MetricType::Gauge);
  MetricFamily error = family("alvor_solve_estimated_error", "Estimated nRMSE of a running solve.", MetricType::Gauge);
  double worst_gap = 0;
  Lock hold(lock_);
  std::map<std::string, Seen> now;
  for (const auto& solve : solves_.all()) {
    const SolveRecord facts = solve->describe();
    ++count[facts.status];
    const Step step = facts.last_step.value_or(nothing_known);
    // Work that an earlier run of the server did does not count for this run.
    const auto before = seen_.find(facts.name);
    const Seen since = before != seen_.end() ? before->second : Seen{};
    if (before != seen_.end() || facts.restarts == 0) {
      shots_ += step.shots - std::min<std::uint64_t>(step.shots, since.shots);
      rays_ += step.rays - std::min<std::uint64_t>(step.rays, since.rays);
    }
    now[facts.name] = {step.shots, step.rays};
    if (facts.balance) worst_gap = std::max(worst_gap, std::abs(facts.balance->gap()));
    if (facts.status != SolveStatus::running) continue;
    const std::vector<ClientMetric::Label> labels{{"solve", facts.name}};
    add(leaves, static_cast<double>(step.leaves), labels);
    add(unshot, step.unshot_fraction, labels);
    add(error, step.estimated_error, labels);
  }
  seen_ = std::move(now);
  MetricFamily states = family("alvor_solves", "Solves by state; those QUEUED wait for their turn.", MetricType::Gauge);
  for (const auto& [status, solves] : count) add(states, solves, {{"state", std::string(text(status))}});
  for (MetricFamily* each : {&states, &leaves, &unshot, &error}) families.push_back(std::move(*each));
  families.push_back(one("alvor_worst_balance_gap",
                         "Of the emitted power, what a solve that has ended does not account for, at most.", MetricType::Gauge,
                         worst_gap));
  families.push_back(one("alvor_shots_total", "Shots of all solves.", MetricType::Counter, static_cast<double>(shots_)));
  families.push_back(one("alvor_rays_total", "Rays of all solves.", MetricType::Counter, static_cast<double>(rays_)));
}

std::vector<MetricFamily> DoorMetrics::Collect() const {
  const FrontDoor::Counts counts = door_.counts();
  return {one("alvor_connections", "Connections at --listen.", MetricType::Gauge, static_cast<double>(counts.open)),
          one("alvor_connections_refused_total", "Connections that were closed because there were too many.", MetricType::Counter,
              static_cast<double>(counts.refused))};
}

std::vector<MetricFamily> RankMetrics::Collect() const {
  MetricFamily memory =
      family("alvor_rank_memory_bytes", "Memory in use by a rank that the system cannot take back.", MetricType::Gauge);
  MetricFamily limit = family("alvor_rank_memory_limit_bytes", "Memory that a rank may use; 0 is no limit.", MetricType::Gauge);
  MetricFamily cpu = family("alvor_rank_cpu_seconds_total", "Processor time of a rank.", MetricType::Counter);
  MetricFamily solving = family("alvor_rank_solving", "1 if a rank shares in the work of a solve, else 0.", MetricType::Gauge);
  const std::vector<RankStatus> statuses = ranks_.statuses();
  for (std::size_t r = 0; r < statuses.size(); ++r) {
    const std::vector<ClientMetric::Label> label{{"rank", std::to_string(r)}};
    add(memory, static_cast<double>(statuses[r].resident_bytes), label);
    add(limit, static_cast<double>(statuses[r].memory_limit), label);
    add(cpu, statuses[r].cpu_s, label);
    add(solving, statuses[r].is_solving, label);
  }
  return {memory, limit, cpu, solving};
}

}  // namespace alvor
