// Random edits, states and losses: whoever watches ends with what the server has.

#include "proto/codec.h"
#include "proto/leaf_codec.h"
#include "server/solves/stored_solve.h"
#include "server/watch/frame_source.h"
#include "solution/solution_mirror.h"
#include "tests/random/dice.h"
#include "tests/server/editing.h"

#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace alvor {
namespace {

Scene room_with_lamps() {
  Scene scene = test::room();
  scene.objects.insert(scene.objects.begin(), {.name = "wall", .first_face = 1, .face_count = 1});
  return scene;
}

/// A solve whose scene is edited at random and whose log gets states at random: of all edits that were made, or of fewer.
class RandomSolve {
 public:
  RandomSolve(SceneStore& scenes, const std::string& scene, test::Dice& dice)
      : solve(std::make_shared<StoredSolve>(1, scenes.use(scene).scene, Caller{}, SolveSpec{}, SolveOptions{}, Keeping{})),
        dice_(dice) {}

  void edit() {
    EditRequest request;
    request.author = dice_.one_of({"Ann", "Ben"});
    request.continues = dice_.happens(0.3);
    if (dice_.happens(0.15)) request.step.kind = EditStep::Kind::undo;
    else if (dice_.happens(0.1)) request.step.kind = EditStep::Kind::redo;
    else request.step.edits = any_edits();
    try {
      solve->edit(request, [] {});
    } catch (const StatusError& refusal) {
      EXPECT_EQ(refusal.code, grpc::FAILED_PRECONDITION) << refusal.what();  // there is nothing to undo or redo
    }
  }
  void publish(bool heeds_all) {
    if (heeds_all || dice_.happens(0.6)) heeded_ = solve->newest_edits(), roots_ = root_count();
    std::vector<LeafValue> changed;
    for (std::uint32_t root = 0; root < roots_; ++root)
      if (heeds_all || dice_.happens(0.3)) changed.push_back({PatchId::root(root), {float(dice_.below(99)), 1, 2}});
    Step step;
    step.edits = heeded_;
    solve->log()->publish(changed, step);
  }
  std::size_t root_count() const { return solve->content({}, std::nullopt)->mesh.roots().size(); }

  const std::shared_ptr<StoredSolve> solve;

 private:
  std::vector<SceneEdit> any_edits() {
    const char* const lamp = dice_.one_of({"lamp.0", "lamp.1"});
    switch (dice_.below(6)) {
      case 0: return {MaterialEdit{.name = "m0", .reflectance = Rgb{dice_.between(0, 0.9), 0.1, 0.2}}};
      case 1: return {ObjectEdit{.name = lamp, .dim = dice_.between(0.1, 2)}};
      case 2: return {ObjectEdit{.name = lamp, .move = Vec3{dice_.between(-1, 1), 0, 0.1}}};
      case 3: return {ObjectEdit{.name = "wall", .hidden = dice_.happens(0.5)}};
      case 4: return {LightEdit{.name = "bulb", .dim = dice_.between(0.1, 2)}};
      default: {
        const std::string name = "copy " + std::to_string(++copies_);
        return {ObjectCopy{name, dice_.one_of({"lamp.0", "wall"})}, ObjectEdit{.name = name, .move = Vec3{0.2, -0.1, 0.3}}};
      }
    }
  }

  test::Dice& dice_;
  int copies_ = 0;
  std::uint64_t heeded_ = 0;
  std::size_t roots_ = root_count();
};

/// A watcher over a stream that loses frames, repeats them and breaks off, as a page keeps its state: a mirror and the last look.
class Watcher {
 public:
  Watcher(std::shared_ptr<StoredSolve> solve, std::size_t page, test::Dice& dice)
      : solve_(std::move(solve)), frames_(solve_, "epoch", page), dice_(dice) {}

  void read_a_frame() {
    const auto frame = next_frame();
    if (dice_.happens(0.1)) return reconnect();  // lost
    take(*frame);
    if (dice_.happens(0.05)) take(*frame);  // repeated
    if (dice_.happens(0.1)) reconnect();
  }
  void finish() {
    reconnect();
    while (mirror_.revision() < frames_.head() || cursor_.is_inside_round()) take(*next_frame());
  }
  const SolutionMirror& mirror() const { return mirror_; }
  const v1::Look& look() const { return look_; }

 private:
  std::shared_ptr<const Frame> next_frame() {
    auto frame = frames_.frame_after(cursor_, Detail::exact);
    cursor_ = frame->next;
    return frame;
  }
  /// As a page does, which begins anew where it is in the middle of a round.
  void reconnect() {
    if (!mirror_.whole()) mirror_ = {}, look_ = {};
    cursor_ = {.base = mirror_.revision()};
  }

  void take(const Frame& frame) {
    v1::WatchSolveResponse message;
    grpc::Slice bytes = frame.bytes;
    ASSERT_TRUE(message.ParseFromArray(bytes.begin(), static_cast<int>(bytes.size())));
    Delta delta;
    ASSERT_FALSE(decode(message, delta));
    if (mirror_.apply(delta)) return reconnect();  // it does not follow the frame before
    if (message.has_look()) look_ = message.look();
    for (const v1::Step& step : message.steps()) EXPECT_LE(step.edits(), look_.edits()) << "a look comes before its states";
    for (const LeafValue& leaf : delta.values)
      EXPECT_LT(leaf.patch.root_face(), known_roots()) << "of an object that is not known";
  }
  std::size_t known_roots() const {
    std::size_t roots = solve_->submitted_roots();
    for (const v1::LookOfObject& object : look_.objects())
      if (object.has_copy_of()) roots += object.face_count();  // of one side each
    return roots;
  }

  const std::shared_ptr<StoredSolve> solve_;
  FrameSource frames_;
  test::Dice& dice_;
  SolutionMirror mirror_;
  v1::Look look_;
  Cursor cursor_;
};

TEST(WatchedEdits, WhateverTheStreamDoesEndWithWhatTheServerHas) {
  SceneStore scenes;
  const std::string scene = scenes.add(room_with_lamps(), "")->facts.name;
  for (int seed = 0; seed < 10'000; ++seed) {
    test::Dice dice(static_cast<std::uint64_t>(seed));
    RandomSolve random(scenes, scene, dice);
    Watcher watcher(random.solve, 1 + dice.below(20), dice);
    for (int n = 0; n < 20; ++n) {
      if (dice.happens(0.4)) random.edit();
      if (dice.happens(0.6)) random.publish(false);
      for (std::uint32_t frames = dice.below(4); frames > 0; --frames) watcher.read_a_frame();
      ASSERT_FALSE(testing::Test::HasFailure()) << "seed " << seed;
    }
    random.publish(true);
    watcher.finish();
    ASSERT_EQ(watcher.mirror().leaves(), random.solve->log()->leaves(Detail::exact)) << "seed " << seed;
    const v1::Look expected = random.solve->newest_edits() > 0 ? random.solve->look() : v1::Look();
    ASSERT_TRUE(google::protobuf::util::MessageDifferencer::Equals(watcher.look(), expected))
        << "seed " << seed << ": " << watcher.look().ShortDebugString() << " instead of " << expected.ShortDebugString();
  }
}

}  // namespace
}  // namespace alvor
