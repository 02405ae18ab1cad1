#include "fuzz/scene_calls.h"
#include "soak/world.h"

namespace radar::soak {

namespace {

class WildWorld : public World {
 public:
  explicit WildWorld(tools::Random& random) : random_(random), choices_(refill()), calls_(choices_) {
    while (calls_.scene().objectLimit() < 3) edit();
  }
  const Scene& scene() const override { return calls_.scene(); }
  void edit() override {
    choices_ = fuzz::Choices(refill());
    for (uint32_t count = 1 + random_.below(4); count > 0; --count) calls_.edit();  // which holds it against its model
  }
  std::vector<Query> queries(uint32_t most) override {
    std::vector<Query> all;
    for (int tries = 0; tries < 4 && all.size() < most; ++tries) {
      choices_ = fuzz::Choices(refill());
      for (Query& query : calls_.queries(most - static_cast<uint32_t>(all.size()))) {
        if (validate(query, scene()).empty()) all.push_back(std::move(query));
      }
    }
    return all;
  }
  std::string name() const override { return "wild"; }

 private:
  std::string_view refill() {
    bytes_.resize(1 << 15);
    for (char& byte : bytes_) byte = static_cast<char>(random_.below(256));
    return bytes_;
  }

  tools::Random& random_;
  std::string bytes_;
  fuzz::Choices choices_;
  fuzz::SceneCalls calls_;
};

}  // namespace

std::unique_ptr<World> makeWildWorld(tools::Random& random) {
  return std::make_unique<WildWorld>(random);
}

}  // namespace radar::soak
