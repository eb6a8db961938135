#include "bench/stability/page.h"

#include "bench/error_vs_time/contest/figures.h"

#include <cmath>

namespace alvor::bench {

namespace {

std::string known(double number) { return std::isfinite(number) ? figure(number, 2) : "-"; }

std::string verdict(const Case& looked_at, const Measured& measured) {
  return (looked_at.holds(measured) ? "holds" : "**fails**") + (measured.end.empty() ? "" : ", " + measured.end);
}

std::string row(const Case& looked_at, const Measured& measured) {
  const bool was_solved = measured.seconds > 0;
  return table_row({looked_at.name, looked_at.condition, looked_at.expected, measured.obtained, known(measured.error),
                    was_solved ? known(measured.estimate) : "-", was_solved ? figure(measured.steps, 7) : "-",
                    was_solved ? plain(measured.seconds) : "-", verdict(looked_at, measured)});
}

std::string table(const Section& section, const std::vector<Measured>& measured) {
  std::string text =
      table_head({"case", "condition", "expected", "obtained", "error", "estimate", "shots", "seconds", "verdict"});
  for (std::size_t n = 0; n < measured.size(); ++n) text += row(section.cases[n], measured[n]);
  return text;
}

/// Returns the list of cases that do not hold, with the reason where it is known.
std::string failures(std::span<const Section> sections, const Findings& findings) {
  std::string text;
  for (std::size_t s = 0; s < sections.size(); ++s)
    for (std::size_t n = 0; n < findings[s].size(); ++n) {
      const Case& looked_at = sections[s].cases[n];
      if (looked_at.holds(findings[s][n]) && looked_at.remark.empty()) continue;
      text +=
          "- " + looked_at.name + ", " + looked_at.condition + (looked_at.remark.empty() ? "" : ": " + looked_at.remark) + '\n';
    }
  return text;
}

std::string head(const Findings& findings, std::span<const Section> sections) {
  std::size_t held = 0, all = 0;
  for (std::size_t s = 0; s < sections.size(); ++s)
    for (std::size_t n = 0; n < findings[s].size(); ++n, ++all) held += sections[s].cases[n].holds(findings[s][n]);
  return "# Stiff and extreme scenes\n\n"
         "This page shows what the solver makes of scenes in which hardly any light is absorbed, and of scenes at the "
         "limits of what a file may hold. Each line compares a solve with a closed form, an invariant or a dense "
         "solution. `scripts/stability.sh` measures all of them again and writes this page. The quick cases are tests "
         "too. " +
         std::to_string(held) + " of " + std::to_string(all) +
         " cases hold.\n\n"
         "- *Error* is relative to what is expected, in the worst band; where a case says \"every leaf\", it is that of "
         "the worst leaf.\n"
         "- *Estimate* is what the solve itself says: the estimated nRMSE, or for bare systems of rows the bound on what"
         " is still to come.\n"
         "- *Shots* are rows gathered or patches shot. All solves use one thread.\n";
}

}  // namespace

std::vector<Section> all_sections() {
  return {{"Closed forms", "Solves with default options. Where all surfaces emit, rows that sum to 1 make the solution exact.",
           closed_form_cases()},
          {"Known means", "Solves with tolerance 1 %, compared with solutions of the continuous equation.", reference_cases()},
          {"Slow diffusion",
           "Linear systems of rows without a solve around them, compared with Gaussian elimination of the same rows in 80 "
           "bits. The error is that of radiosity, RMS over the mean.",
           dense_cases()},
          {"Steps to an error of 1e-6",
           "A step reads one row or column. Steps are counted per patch (n): direct light, the first unshot light, and the"
           " sweeps. The steps in *expected* are those of other methods with exact form factors on the same scenes. The "
           "coarse grid and the bound on what is still to come read all rows once more each; that is not counted.",
           step_cases()},
          {"Geometry", "Awkward geometry must be solved right, or refused with the place.", geometry_cases()},
          {"Shadows",
           "A lit room with a blocker that touches or crosses the lamp or what it darkens, lies in its plane, is a sliver, or is there "
           "twice. Solves with tolerance 1.5 %, where shadows of few blockers are exact. The error is the nRMSE beside 1000 paths at each of "
           "400 points.",
           shadow_cases()},
          {"Light", "Extreme light must be solved right, or refused with the place.", light_cases()}};
}

std::string page(std::span<const Section> sections, const Findings& findings) {
  std::string text = head(findings, sections);
  for (std::size_t s = 0; s < sections.size(); ++s)
    text += "\n## " + sections[s].title + "\n\n" + sections[s].text + "\n\n" + table(sections[s], findings[s]);
  const std::string remarks = failures(sections, findings);
  return text + (remarks.empty() ? "" : "\n## Remarks\n\n" + remarks);
}

}  // namespace alvor::bench
