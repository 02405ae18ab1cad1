// What tells one query file from another.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "workloads/workload.h"

namespace radar::tools {

/// A hash (XXH3, 128 bits) of all that is added, in order: equal content gives equal hashes on every machine.
class Fingerprint {
 public:
  Fingerprint();
  ~Fingerprint();
  Fingerprint(const Fingerprint&) = delete;
  Fingerprint& operator=(const Fingerprint&) = delete;

  void add(std::span<const std::byte> bytes);
  /// The meshes and scenes of a workload, without the names of its files.
  void addWorld(const Workload& workload);
  void add(const QuerySpec& query);
  /// 32 hexadecimal digits.
  std::string text() const;

 private:
  template <class Value>
  void addValue(const Value& value);
  template <class Value>
  void addList(const std::vector<Value>& list);
  void add(const std::string& text);
  void add(const Instance& instance);

  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace radar::tools
