#include "client/rpc/client.h"
#include "tests/server/sample_scenes.h"
#include "tests/server/staged_solver.h"
#include "tests/server/test_server.h"

#include <gtest/gtest.h>
#include <prometheus/metric_family.h>

#include <optional>

namespace alvor {
namespace {

/// Returns the family's sample whose labels have these values, in the order of the labels' names.
std::optional<double> sample(const TestServer& server, const std::string& name, const std::vector<std::string>& labels = {}) {
  for (const prometheus::MetricFamily& family : server.metrics()->Collect()) {
    if (family.name != name) continue;
    for (const prometheus::ClientMetric& metric : family.metric) {
      std::map<std::string, std::string> named;
      for (const auto& label : metric.label) named[label.name] = label.value;
      std::vector<std::string> values;
      for (const auto& [label, value] : named) values.push_back(value);
      if (values == labels) return family.type == prometheus::MetricType::Counter ? metric.counter.value : metric.gauge.value;
    }
  }
  return std::nullopt;
}

TEST(Metrics, TellWhatTheServerDoes) {
  StagedSolver stage;
  ServiceOptions options;
  options.solves.solver = stage.solver();
  TestServer server(options);
  Client client(server.channel());
  const v1::Scene scene = client.create_scene(squares(2), "");
  const v1::Solve solve = client.create_solve(scene.name(), {});
  Step step;
  step.rays = 7;
  step.unshot_fraction = 0.25;
  stage.log().publish({}, step);
  EXPECT_EQ(sample(server, "alvor_scenes"), 1);
  EXPECT_EQ(sample(server, "alvor_solves", {"RUNNING"}), 1);
  EXPECT_EQ(sample(server, "alvor_rays_total"), 7);
  EXPECT_EQ(sample(server, "alvor_solve_unshot_fraction", {solve.name()}), 0.25);
  stage.finish();
  while (client.get_solve(solve.name()).state() == v1::Solve::RUNNING) std::this_thread::yield();
  EXPECT_EQ(sample(server, "alvor_solves", {"RUNNING"}), 0);
  EXPECT_EQ(sample(server, "alvor_solves", {"SUCCEEDED"}), 1);
  EXPECT_EQ(sample(server, "alvor_rays_total"), 7) << "it is told once";
}

TEST(Metrics, CountCallsByMethodAndStatus) {
  TestServer server;
  Client client(server.channel());
  client.create_scene(squares(2), "");
  for (int n = 0; n < 3; ++n) EXPECT_THROW(client.get_scene("scenes/none"), RpcError);
  EXPECT_EQ(sample(server, "alvor_calls_total", {"NOT_FOUND", "/alvor.v1.SceneService/GetScene"}), 3);
  EXPECT_EQ(sample(server, "alvor_calls_total", {"OK", "/alvor.v1.SceneService/CreateScene"}), 1);
  EXPECT_EQ(sample(server, "alvor_calls_total", {"OK", "/alvor.v1.SceneService/GetScene"}), std::nullopt);
}

}  // namespace
}  // namespace alvor
