#include "diagnosis/score/sealed_set.hpp"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

#include "base/atomic_file.hpp"
#include "base/error.hpp"
#include "base/sha256.hpp"
#include "diagnosis/statistics/statistics.hpp"

namespace snag {

namespace {

constexpr double strengths[] = {0.125, 0.25, 0.5, 1};
constexpr int replicates[] = {1, 3, 10, 50};

// Of ten sets two are null, five have one effect, two have two, one has none of the library; the seed says in which order. Every third
// null has inputs that are 2.5 standard uncertainties off.
std::string kind_of(int number, std::uint64_t seed) {
  constexpr std::array kinds{"single", "null", "single", "pair", "single", "outside", "single", "null", "pair", "single"};
  constexpr int n = static_cast<int>(kinds.size()), first_null = 1;
  const int block = number / n;
  std::array<int, n> order;
  for (int i = 0; i < n; ++i) order[i] = i;
  NormalNumbers random(seed * 611953 + static_cast<std::uint64_t>(block) * 15485863 + 5);
  for (int i = n - 1; i > 0; --i) std::swap(order[i], order[random.index(i + 1)]);
  const int slot = order[number % n];
  const std::string kind = kinds[slot];
  return kind == "null" && (2 * block + (slot == first_null)) % 3 == 0 ? "null_off" : kind;
}

}  // namespace

std::string Truth::name() const {
  if (!unmodelled.empty()) return "outside";
  std::string all;
  for (const auto& [effect, value] : theta) all += (all.empty() ? "" : "+") + effect;
  return all.empty() ? "none" : all;
}

Truth planned_set(int number, std::uint64_t seed, const std::vector<std::string>& effects, const std::vector<std::string>& of_pairs,
                  const std::vector<std::string>& unmodelled_forces, const std::vector<std::string>& subsets) {
  NormalNumbers random(seed * 1000003 + static_cast<std::uint64_t>(number));
  const auto one_of = [&](const auto& list) { return list[static_cast<std::size_t>(random.index(static_cast<int>(std::size(list))))]; };
  Truth truth;
  truth.number = number;
  truth.kind = kind_of(number, seed);
  if (truth.kind == "outside" && unmodelled_forces.empty()) truth.kind = "null";
  truth.subset = random.uniform() < 0.6 ? subsets.front() : one_of(subsets);
  truth.replicates = one_of(replicates);
  if (truth.kind == "single") {
    const std::string effect = one_of(effects);
    truth.theta[effect] = truth.strength = one_of(strengths);
  }
  while (truth.kind == "pair" && truth.theta.size() < 2 && of_pairs.size() > 1) {
    const std::string effect = one_of(of_pairs);
    truth.theta.try_emplace(effect, truth.strength = random.uniform() < 0.5 ? 0.5 : 1);
  }
  if (truth.kind == "outside") truth.unmodelled = one_of(unmodelled_forces), truth.strength = random.uniform() < 0.5 ? 0.5 : 1;
  return truth;
}

std::string seal(const Truth& truth, const std::filesystem::path& file) {
  const nlohmann::ordered_json json{{"number", truth.number},
                                    {"kind", truth.kind},
                                    {"theta", truth.theta},
                                    {"outside", truth.unmodelled},
                                    {"strength", truth.strength},
                                    {"subset", truth.subset},
                                    {"replicates", truth.replicates},
                                    {"detectability", truth.detectability},
                                    {"gap_over_floor", truth.gap_over_floor}};
  const std::string text = json.dump(2) + "\n";
  std::filesystem::create_directories(file.parent_path());
  write_atomically(file, text);
  return sha256(text);
}

Truth opened(const std::filesystem::path& file, const std::string& fingerprint) {
  const auto text = file_text(file);
  if (!text) throw Error(ExitCode::io, file.string() + ": the sealed truth cannot be read");
  if (sha256(*text) != fingerprint)
    throw Error(ExitCode::invariant, file.string() + ": is not the truth that was sealed before the diagnosis (sha256 " +
                                         sha256(*text).substr(0, 12) + ", sealed " + fingerprint.substr(0, 12) + "); make the set again");
  const auto json = nlohmann::json::parse(*text);
  Truth truth;
  truth.number = json.at("number"), truth.kind = json.at("kind"), truth.unmodelled = json.at("outside");
  truth.theta = json.at("theta").get<std::map<std::string, double>>();
  truth.strength = json.at("strength"), truth.subset = json.at("subset"), truth.replicates = json.at("replicates");
  truth.detectability = json.at("detectability"), truth.gap_over_floor = json.at("gap_over_floor");
  return truth;
}

}  // namespace snag
