// edits --scene S.obj --window W.obj [--tolerance T] [--threads N]: prints the tables of docs/edits.md, for edits of the finished
// furnished room S and for a sun that goes on before the window of the room W. Each is asked of a server in this process; a watch
// that follows edits sees when the first state with it comes, and when one is within the tolerance again; times are also told as
// shares of that of the first solve.

#include "client/rpc/client.h"
#include "import/apart/scene_file.h"
#include "meshing/edit/edited_scene.h"
#include "proto/codec.h"
#include "proto/edit_codec.h"
#include "proto/light_codec.h"
#include "server/base/cpu_time.h"
#include "server/base/memory_guard.h"
#include "server/rpc/service.h"

#include <CLI/CLI.hpp>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <functional>
#include <iostream>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace alvor::bench {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) { return std::chrono::duration<double>(Clock::now() - begin).count(); }

double mebibytes() { return static_cast<double>(resident_bytes()) / (1 << 20); }

/// A server in this process that keeps what its solves know.
class Server {
 public:
  Server() : service_(options()) {
    grpc::ServerBuilder builder;
    service_.register_with(builder);
    server_ = builder.BuildAndStart();
  }
  ~Server() {
    service_.shut_down();
    server_->Shutdown(std::chrono::system_clock::now() + std::chrono::seconds(1));
  }
  std::shared_ptr<grpc::Channel> channel() { return server_->InProcessChannel({}); }

 private:
  static ServiceOptions options() {
    ServiceOptions options;
    options.solves.keeping.keeps_live = true;
    return options;
  }
  Service service_;
  std::unique_ptr<grpc::Server> server_;
};

/// Follows a solve through its edits on a thread of its own.
class Follower {
 public:
  Follower(const std::shared_ptr<grpc::Channel>& channel, std::string solve)
      : stub_(v1::SolveService::NewStub(channel)), solve_(std::move(solve)), thread_([this] { follow(); }) {}
  ~Follower() {
    context_.TryCancel();
    thread_.join();
  }

  /// Waits until a state fits and returns its step.
  Step wait_for(const std::function<bool(const Step&)>& fits) {
    std::unique_lock hold(lock_);
    changed_.wait(hold, [&] { return fits(last_); });
    return last_;
  }

 private:
  void follow() {
    v1::WatchSolveRequest request;
    request.set_name(solve_);
    request.set_detail(v1::DETAIL_DISPLAY);
    request.set_follow_edits(true);
    request.set_max_rate_hertz(1000);
    const auto reader = stub_->WatchSolve(&context_, request);
    std::uint64_t frames = 0;
    for (v1::WatchSolveResponse frame; reader->Read(&frame);) {
      {
        const std::lock_guard hold(lock_);
        if (frame.steps_size() > 0) last_ = decode(*frame.steps().rbegin());
      }
      changed_.notify_all();
      grpc::ClientContext context;
      v1::AcknowledgeFrameRequest acknowledgement;
      acknowledgement.set_watch_id(frame.watch_id());
      acknowledgement.set_revision(frame.to_revision());
      acknowledgement.set_frame_count(++frames);
      v1::AcknowledgeFrameResponse nothing;
      stub_->AcknowledgeFrame(&context, acknowledgement, &nothing);
    }
  }

  std::unique_ptr<v1::SolveService::Stub> stub_;
  const std::string solve_;
  grpc::ClientContext context_;
  std::mutex lock_;
  std::condition_variable changed_;
  Step last_;
  std::thread thread_;  // uses all of the above
};

v1::EditStep of_object(v1::ObjectEdit edit) {
  v1::EditStep step;
  *step.add_edits()->mutable_object() = std::move(edit);
  return step;
}

v1::EditStep dim_object(const std::string& name, double factor) {
  v1::ObjectEdit edit;
  edit.set_name(name);
  edit.set_dim(factor);
  return of_object(std::move(edit));
}

v1::EditStep moved(const std::string& name, const Vec3& by) {
  v1::ObjectEdit edit;
  edit.set_name(name);
  *edit.mutable_move() = encode_vector(by);
  return of_object(std::move(edit));
}

v1::EditStep turned(const std::string& name, double degrees) {
  v1::ObjectEdit edit;
  edit.set_name(name);
  edit.set_turn(degrees);
  return of_object(std::move(edit));
}

v1::EditStep hidden(const std::string& name) {
  v1::ObjectEdit edit;
  edit.set_name(name);
  edit.set_hidden(true);
  return of_object(std::move(edit));
}

v1::EditStep added(const std::string& name, const std::string& of, const Vec3& by) {
  v1::EditStep step = moved(name, by);
  step.add_edits()->mutable_copy()->set_name(name);
  step.mutable_edits(1)->mutable_copy()->set_of(of);
  return step;
}

v1::EditStep recolour(const std::string& name, const Rgb& reflectance) {
  v1::EditStep step;
  step.add_edits()->mutable_material()->set_name(name);
  *step.mutable_edits(0)->mutable_material()->mutable_reflectance() = encode(reflectance);
  return step;
}

/// The sun and a clear sky over Munich on 21 March 2026, so many minutes after 09:00 UTC.
v1::EditStep morning(int minutes) {
  constexpr std::int64_t nine = 1'774'083'600;
  v1::EditStep step;
  v1::Daylight& daylight = *step.add_edits()->mutable_daylight();
  daylight.set_sky(v1::Daylight::CIE);
  daylight.set_cie_number(12);
  daylight.set_ground_reflectance(0.2);
  daylight.mutable_sun_time()->set_latitude_degrees(48.1);
  daylight.mutable_sun_time()->set_longitude_degrees(11.6);
  daylight.mutable_sun_time()->mutable_time()->set_seconds(nine + 60 * minutes);
  return step;
}

/// A scene as it stands with a step of edits.
Scene with(const Scene& scene, const v1::EditStep& step) { return edited_scene(scene, decode(step).value().edits); }

v1::EditStep undo() {
  v1::EditStep step;
  step.set_kind(v1::EditStep::UNDO);
  return step;
}

struct Measured {
  std::uint64_t rays = 0;
  double first_s = 0, within_s = 0;
};

/// Aims for one edit of a finished solve: upper bounds, where they are given.
struct Aim {
  std::optional<double> rays_share;         ///< of the rays of a solve from nothing
  std::optional<double> first_s, within_s;  ///< until the first state is shown, until the tolerance is reached again
  std::optional<double> within_share;       ///< within_s as a share of the time of a solve from nothing

  bool is_met(double rays, double first, double within, double share) const {
    const auto keeps = [](double value, const std::optional<double>& most) { return !most || value <= *most; };
    return keeps(rays, rays_share) && keeps(first, first_s) && keeps(within, within_s) && keeps(share, within_share);
  }
  /// Returns the bounds as text, "" if there are none.
  std::string text() const {
    std::string text;
    const auto add = [&](const std::string& words) { text += (text.empty() ? "" : ", ") + words; };
    const auto percent = [](double share) { return std::to_string(std::lround(100 * share)) + " %"; };
    const auto time = [](double s) {
      return s < 1 ? std::to_string(std::lround(1e3 * s)) + " ms" : std::to_string(std::lround(s)) + " s";
    };
    if (rays_share) add(*rays_share == 0 ? "no ray" : percent(*rays_share) + " of rays");
    if (first_s) add(time(*first_s));
    if (within_s) add(time(*within_s));
    if (within_share) add(percent(*within_share) + " of time");
    return text;
  }
};

class Bench {
 public:
  Bench(const Scene& scene, double tolerance, int threads) : client_(server_.channel()), tolerance_(tolerance) {
    spec_.set_tolerance(tolerance);
    spec_.set_threads(threads);
    spec_.set_max_elements(1'000'000);  // no edit is to end at the limit
    scene_ = client_.create_scene(scene, "").name();
    Client::Watch watch;
    const auto begin = Clock::now();
    solve_ = client_.create_solve(scene_, spec_).name();
    fresh_ = decode(client_.watch_solve(solve_, watch, [](auto&) {}).last_step());
    fresh_s_ = seconds_since(begin);
    follower_ = std::make_unique<Follower>(server_.channel(), solve_);
    follower_->wait_for([&](const Step& step) { return step.revision == fresh_.revision; });
  }

  /// Waits until the solve rests at the tolerance.
  void rest() {
    Client::Watch watch;
    client_.watch_solve(solve_, watch, [](auto&) {});
  }

  Measured edit(const v1::EditStep& step) {
    rest();
    const std::uint64_t rays = decode(client_.get_solve(solve_).last_step()).rays;
    const auto begin = Clock::now();
    const std::uint64_t revision = client_.edit_solve(solve_, step).revision();
    Measured measured;
    follower_->wait_for([&](const Step& now) { return now.edits >= revision; });
    measured.first_s = seconds_since(begin);
    const Step last = follower_->wait_for(
        [&](const Step& now) { return now.edits >= revision && !now.is_provisional && now.estimated_error <= tolerance_; });
    measured.within_s = seconds_since(begin);
    measured.rays = last.rays - rays;
    rest();
    return measured;
  }

  void row(const std::string& name, const v1::EditStep& step, const Aim& aim = {}) {
    const Measured once = edit(step), back = edit(undo());
    tell(name, once, aim);
    tell("... taken back", back, aim);
    std::fflush(stdout);
  }

  /// Thirty edits a second for ten seconds, as a slider makes them.
  void slide(const std::string& object) {
    rest();
    constexpr int count = 300;
    constexpr auto between = std::chrono::microseconds(1'000'000 / 30);
    std::vector<Clock::time_point> sent(count + 1);
    std::vector<double> behind;
    const std::uint64_t before = follower_->wait_for([](const Step&) { return true; }).edits;
    std::mutex lock;
    std::thread watching([&] {
      std::uint64_t seen = before;
      std::size_t first_not_seen = 1;
      while (first_not_seen <= count) {
        const Step step = follower_->wait_for([&](const Step& now) { return now.edits > seen; });
        seen = step.edits;
        const std::lock_guard hold(lock);
        // How old the first edit was that was not shown until now.
        behind.push_back(seconds_since(sent[first_not_seen]));
        first_not_seen = static_cast<std::size_t>(seen - before) + 1;
      }
    });
    const double cpu = cpu_seconds(), memory = mebibytes();
    const auto begin = Clock::now();
    for (int n = 1; n <= count; ++n) {
      {
        const std::lock_guard hold(lock);
        sent[static_cast<std::size_t>(n)] = Clock::now();
      }
      v1::EditStep step = dim_object(object, 0.5 + 0.5 * n / count);
      step.set_continues(true);
      client_.edit_solve(solve_, step);
      std::this_thread::sleep_until(begin + n * between);
    }
    const double took = seconds_since(begin), spent = cpu_seconds() - cpu, grown = mebibytes() - memory;
    watching.join();
    edit(undo());
    std::ranges::sort(behind);
    constexpr double most_behind_s = 0.15, most_cores = 1;
    const bool is_met = behind.back() <= most_behind_s && spent <= most_cores * took;
    std::printf(
        "A slider: %d edits in %.1f s, %zu states shown, behind by %.0f ms (median), %.0f ms (most); %.2f cores; %.0f MiB of "
        "memory before, %+.0f MiB after. Aim: never behind by more than 150 ms, one core: %s\n",
        count, took, behind.size(), 1e3 * behind[behind.size() / 2], 1e3 * behind.back(), spent / took, memory, grown,
        is_met ? "met" : "**missed**");
  }

  void tell_fresh() const {
    std::printf("A solve from nothing: %.2f s, %llu rays, %llu leaves, estimated error %.2f %%.\n\n", fresh_s_,
                static_cast<unsigned long long>(fresh_.rays), static_cast<unsigned long long>(fresh_.leaves),
                100 * fresh_.estimated_error);
  }

 private:
  void tell(const std::string& name, const Measured& of, const Aim& aim) const {
    const double rays_share = static_cast<double>(of.rays) / static_cast<double>(fresh_.rays), share = of.within_s / fresh_s_;
    const bool is_met = aim.is_met(rays_share, of.first_s, of.within_s, share);
    const std::string text = aim.text(), verdict = text.empty() ? "" : text + (is_met ? ": met" : ": **missed**");
    std::printf("| %s | %llu | %.1f %% | %.0f ms | %.0f ms | %.1f %% | %s |\n", name.c_str(),
                static_cast<unsigned long long>(of.rays), 100 * rays_share, 1e3 * of.first_s, 1e3 * of.within_s, 100 * share,
                verdict.c_str());
  }

  Server server_;
  Client client_;
  const double tolerance_;
  v1::SolveSpec spec_;
  std::string scene_, solve_;
  Step fresh_;
  double fresh_s_ = 0;
  std::unique_ptr<Follower> follower_;
};

void tell_head() {
  std::puts(
      "| edit | rays | of all rays of a solve from nothing | first state | at the tolerance again | of its time | aim "
      "|\n|---|---|---|---|---|---|---|");
}

/// Moves a desk with all that stands on it.
void measure_office(const Scene& office, int threads) {
  constexpr double of_office = 0.1;
  Bench bench(office, of_office, threads);
  bench.tell_fresh();
  tell_head();
  bench.row("move a desk by half a metre", moved("desk.010", {0, 0, -0.5}), {.rays_share = 0.01, .within_share = 0.03});
}

int run(int count, char** arguments) {
  CLI::App app("Measures edits of a finished solve");
  std::string path, window_path, office_path;
  double tolerance = 0.02;
  int threads = 0;
  app.add_option("--scene", path)->required();
  app.add_option("--window", window_path)->required();
  app.add_option("--tolerance", tolerance);
  app.add_option("--threads", threads);
  app.add_option("--office", office_path, "An office block of bench/office_block, in which a desk is moved")->required();
  CLI11_PARSE(app, count, arguments);
  Bench bench(read_scene_file(path).scene, tolerance, threads);
  bench.tell_fresh();
  tell_head();
  bench.row("dim one of two lamps to a half", dim_object("lamp.001", 0.5), {.rays_share = 0, .first_s = 0.05, .within_s = 0.3});
  bench.row("switch it off", dim_object("lamp.001", 0));
  v1::EditStep both = dim_object("lamp.001", 0.5);
  *both.add_edits() = dim_object("lamp.002", 0.5).edits(0);
  bench.row("dim both lamps to a half", both);
  bench.row("recolour all walls", recolour("wall", {0.35, 0.45, 0.7}), {.rays_share = 0, .first_s = 0.05, .within_s = 1});
  bench.row("recolour the rug", recolour("rug", {0.1, 0.3, 0.1}));
  bench.row("move a chair by half a metre", moved("chair.003", {-0.3, 0, 0.4}), {.rays_share = 0.15, .within_share = 0.2});
  bench.row("turn a chair by 30 degrees", turned("chair.003", 30));
  bench.row("hide the table", hidden("table"), {.rays_share = 0.2, .within_share = 0.25});
  bench.row("add another chair", added("chair.006", "chair.003", {0.5, 0, 0}));
  std::puts("");
  bench.slide("lamp.002");
  std::puts("");
  measure_office(read_scene_file(office_path).scene, threads);
  std::puts("");
  Scene window = read_scene_file(window_path).scene;
  window.quantity = Quantity::photometric;
  constexpr double of_day = 0.1;  // the sun's edge and the reveals keep the error of a fine mesh above a twentieth
  Bench day(with(window, morning(0)), of_day, threads);
  day.tell_fresh();
  tell_head();
  day.row("sun and sky by ten minutes", morning(10), {.rays_share = 0.1});
  day.row("by two hours", morning(120));
  return 0;
}

}  // namespace

}  // namespace alvor::bench

int main(int count, char** arguments) { return alvor::bench::run(count, arguments); }
