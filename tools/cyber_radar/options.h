// Options that several commands share.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "command/command.h"
#include "cyber_radar/answering.h"

namespace radar::tools {

struct NamedOption {
  const char* name;
  Option option;
};

/// --mode, --resolution, --device, --cpu-batch, --threads.
struct EngineOptions {
  std::string mode = "contact", resolution = "auto";
  std::optional<std::string> device;
  std::optional<uint32_t> cpuBatch;
  uint32_t threads = 0;
  bool severalDevices = false;  ///< --device may name more than one

  /// Returns what was added.
  std::vector<NamedOption> addTo(Command& command);
  std::vector<NamedOption> addResolutionTo(Command& command);
  /// Throws InputError that names the option.
  AnsweringOptions checked() const;
};

/// One sweep given on the command line: a scene file, a sensor file, and how the sensor moves.
struct SweepOptions {
  std::string scene, sensor;
  std::vector<double> direction, at, rotate, turn, centre;
  std::optional<double> distance, scale, sensorScale;
  std::vector<std::string> exclude;
  QuerySpec fields;

  /// All but the two files and what the next two add. Returns what was added.
  std::vector<NamedOption> addMotionTo(Command& command);
  /// --turn and --centre; the direction may then be missing.
  void addTurnTo(Command& command);
  /// Those of queryFields() that are options, and --exclude.
  void addFieldsTo(Command& command);
  /// Reads both files: each node of the scene's is an object of that number, the last mesh is the sensor's. Prints
  /// warnings to standard error. Throws InputError that names the option or file.
  Workload load() const;

 private:
  /// Sets direction and distance, or turn and motion.
  void setCourse(QuerySpec& query) const;
  void setTurn(QuerySpec& query) const;
};

/// --device, of a command that asks several.
void addDevicesTo(Command& command, std::string& devices);
/// "all" or "0,1": the numbers, none for all. Throws InputError that names the option.
std::vector<uint32_t> devicesFrom(const std::string& text);

void printWarnings(const std::vector<std::string>& warnings);

}  // namespace radar::tools
