#include "radiosity/exchange/strategies.h"

#include "radiosity/exchange/shooting.h"

#include <algorithm>
#include <array>
#include <vector>

namespace alvor {

namespace {

constexpr std::uint32_t none = ~0u;

/// Returns the index of the largest of `powers`, the first of equals; `none` if no power is above 0.
std::uint32_t find_largest(std::span<const double> powers) {
  constexpr std::size_t lanes = 16;  // independent maxima, for SIMD
  std::array<double, lanes> best{};
  std::size_t p = 0;
  for (; p + lanes <= powers.size(); p += lanes)
    for (std::size_t k = 0; k < lanes; ++k) best[k] = powers[p + k] > best[k] ? powers[p + k] : best[k];
  double largest = *std::ranges::max_element(best);
  for (; p < powers.size(); ++p) largest = std::max(largest, powers[p]);
  return largest > 0 ? static_cast<std::uint32_t>(std::ranges::find(powers, largest) - powers.begin()) : none;
}

class GatherStepper : public Stepper {
 public:
  explicit GatherStepper(Shooting& system) : system_(system) {}

  bool step() override {
    if (!has_begun_) system_.adopt_unshot();
    has_begun_ = true;
    if (system_.patch_count() == 0) return false;
    system_.gather(next_);
    next_ = (next_ + 1) % static_cast<std::uint32_t>(system_.patch_count());
    return true;
  }

  std::size_t sweep() override {
    std::size_t steps = 0;
    while (steps < system_.patch_count() && step()) ++steps;
    system_.find_unshot();
    return steps;
  }

 private:
  Shooting& system_;
  std::uint32_t next_ = 0;
  bool has_begun_ = false;
};

class ShootStepper : public Stepper {
 public:
  explicit ShootStepper(Shooting& system) : system_(system) {}

  bool step() override {
    for (std::size_t tried = 0; tried < system_.patch_count(); ++tried) {
      const std::uint32_t shooter = next_;
      next_ = (next_ + 1) % static_cast<std::uint32_t>(system_.patch_count());
      if (system_.unshot_power_of(shooter) == 0) continue;
      system_.shoot(shooter);
      return true;
    }
    return false;
  }

  std::size_t sweep() override {
    std::size_t shots = 0;
    for (std::uint32_t p = 0; p < system_.patch_count(); ++p)
      if (system_.unshot_power_of(p) > 0) system_.shoot(p), ++shots;
    return shots;
  }

 private:
  Shooting& system_;
  std::uint32_t next_ = 0;
};

class SortedStepper : public Stepper {
 public:
  explicit SortedStepper(Shooting& system) : system_(system) {}

  bool step() override {
    if (powers_.empty()) look_at_all();
    const std::uint32_t shooter = find_largest(powers_);
    if (shooter == none) return false;
    system_.shoot(shooter);
    look_at(shooter);
    system_.for_each_receiver(shooter, [this](std::uint32_t p) { look_at(p); });
    return true;
  }

  // Shooting all patches above half of the largest power keeps the order by power to within a factor of two, without sorting.
  std::size_t sweep() override {
    powers_.clear();
    double largest = 0;
    for (std::uint32_t p = 0; p < system_.patch_count(); ++p) largest = std::max(largest, system_.unshot_power_of(p));
    std::size_t shots = 0;
    if (largest == 0) return shots;
    for (std::uint32_t p = 0; p < system_.patch_count(); ++p)
      if (system_.unshot_power_of(p) > largest / 2) system_.shoot(p), ++shots;
    return shots;
  }

 private:
  void look_at(std::uint32_t p) { powers_[p] = system_.unshot_power_of(p); }
  void look_at_all() {
    powers_.resize(system_.patch_count());
    for (std::uint32_t p = 0; p < powers_.size(); ++p) look_at(p);
  }

  Shooting& system_;
  std::vector<double> powers_;  // by patch; empty when not kept up
};

/// Sorted shooting that also shoots the ambient term in advance. If the ambient term is far wrong, advancing it may add more
/// unshot power than shots remove. So the share that is advanced shrinks while the unshot power is above its lowest value, and
/// for good if there is no new lowest value for long: shooting without advance always converges.
class OvershootStepper : public Stepper {
 public:
  explicit OvershootStepper(Shooting& system) : system_(system), powers_(system.patch_count()), lowest_(system.unshot_power()) {
    system_.keep_ambient_account();
  }

  bool step() override {
    choose_share();
    const RelativeLight ahead = share_ * system_.ambient_irradiance();
    const std::uint32_t shooter = look_at_all(ahead);
    if (shooter == none) return false;
    system_.shoot(shooter, ahead);
    ++shots_;
    return true;
  }

  std::size_t sweep() override {
    choose_share();
    const RelativeLight ahead = share_ * system_.ambient_irradiance();
    const std::uint32_t first = look_at_all(ahead);
    if (first == none) return 0;
    const double enough = powers_[first] / 2;
    std::size_t shots = 0;
    for (std::uint32_t p = 0; p < powers_.size(); ++p)
      if (system_.unshot_power_of(p, ahead) > enough) system_.shoot(p, ahead), ++shots;
    shots_ += shots;
    return shots;
  }

 private:
  // Multiple of the lowest unshot power from which the advanced share shrinks; advances raise the power until their light has
  // come. Chosen; half and double give the same solutions (docs/design/constants.md).
  static constexpr double usual_rise = 2;
  // Shots per patch without a new lowest unshot power after which the advanced share is halved for good. Chosen; half and double
  // give the same solutions (docs/design/constants.md).
  static constexpr std::size_t patience = 4;

  std::uint32_t look_at_all(const RelativeLight& ahead) {
    for (std::uint32_t p = 0; p < powers_.size(); ++p) powers_[p] = system_.unshot_power_of(p, ahead);
    return find_largest(powers_);
  }
  void choose_share() {
    const double power = system_.unshot_power();
    if (power < lowest_) lowest_ = power, low_at_ = shots_;
    if (shots_ - low_at_ > patience * powers_.size()) trust_ /= 2, low_at_ = shots_;
    share_ = trust_ * (power > usual_rise * lowest_ ? usual_rise * lowest_ / power : 1);
  }

  Shooting& system_;
  std::vector<double> powers_;  // by patch: unshot power with the advance
  double share_ = 1;            // share of the ambient term that is advanced
  double trust_ = 1;            // largest share that may be advanced
  double lowest_ = 0;           // lowest unshot power so far, emission units times m2
  std::size_t shots_ = 0, low_at_ = 0;
};

}  // namespace

std::string_view text(Strategy strategy) {
  switch (strategy) {
    case Strategy::automatic: return "auto";
    case Strategy::sorted: return "sorted";
    case Strategy::sorted_ambient: return "sorted+ambient";
    case Strategy::gather: return "gather";
    case Strategy::shoot: return "shoot";
    case Strategy::overshoot: return "overshoot";
  }
  return "unknown";
}

bool shows_ambient(Strategy strategy) { return strategy == Strategy::automatic || strategy == Strategy::sorted_ambient; }

std::unique_ptr<Stepper> make_stepper(Strategy strategy, Shooting& system) {
  switch (strategy) {
    case Strategy::gather: return std::make_unique<GatherStepper>(system);
    case Strategy::shoot: return std::make_unique<ShootStepper>(system);
    case Strategy::overshoot: return std::make_unique<OvershootStepper>(system);
    default: return std::make_unique<SortedStepper>(system);
  }
}

}  // namespace alvor
