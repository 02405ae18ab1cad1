// Records searches into a host's own command buffers; the answers stay on the device.
//
// The engine submits nothing and waits for nothing here, but for known queries when a device with a queue makes its
// first Recorder (checkAnswers): HostDevice::queue may be null. radar/result.glsl declares the answers' layout
// for shaders.
//
// Ranges: queries with numbers that floats cannot hold become Status::invalid with Flag::range:
// - coordinates beyond 2^80 (an object's, or its bounds': all queries) or more than 10^22 times the sensor's size;
// - sizes below 2^-80; sizes of sensor and object that differ by a factor of more than 10^12, also along an axis on
//   which a mesh is flat but its matrix is not. Of a sensor whose mesh a host deforms without bounds, the rest pose's
//   size counts, too;
// - an object in reach that is more than 10^12 sensor sizes away. Where a host moves objects, or deforms their meshes,
//   without bounds, any object counts, and from 10^11 sensor sizes on;
// - a distance D that is not 0 but below 2^-100 of the sensor's size or 2^-138 of the scene's; no upper limit;
// - a direction whose components differ by a factor of more than about 2^1000;
// - a clearance above 2^29 times the sensor's size or below 2^-40 of the scene's.
#pragma once

#include <array>
#include <bit>

#include "radar/answers.h"
#include "radar/host.h"
#include "radar/scene_copy.h"

namespace radar {

/// Room of one recording, over all queries. Nothing is retried with more: needed() tells what would do. A query that
/// exceeds a limit gets that flag; others are unaffected, unless they share the exhausted resource.
///
/// | member          | counts                                  | 0 stands for   | too small        | bytes |
/// |-----------------|-----------------------------------------|----------------|------------------|-------|
/// | queries         | queries                                 | none           | record() throws  | 830   |
/// | candidates      | pairs of triangles that may be first    | 2,048 to 2     | Flag::candidates | 88    |
/// | rounds          | dispatches of the search; even, to 64   | 16             | Flag::rounds     | none  |
/// | unresolvedPairs | pairs that only the CPU decides         | 128 to 1       | Flag::unresolved | 192   |
/// | searches        | objects searched one by one             | none           | record() throws  | 960   |
///
/// Bytes are about what each takes of the device's memory; for unresolvedPairs, of the host's. Searches count as
/// queries where 0 is chosen. It stands for the largest of 2,048 candidates a query, but at most 2^15 in all, 64 but at
/// most 98,304, 12 but at most 196,608, and 2; of 128 unresolved pairs, but at most 2^13, 16 but at most 2^14, and 1.
/// Without Device::doubles(), there are always 16. If a query's do not fit, read() leaves Flag::unresolved.
///
/// A Recorder whose lists are chosen so takes, without its copy of the scene, at most 8 MB for up to 64 queries; 25.6
/// KB more for each further one up to 1,000, for which it takes 32 MB; and for each beyond, 1 KB of the device's memory
/// and 0.8 KB of the host's, or 3.7 KB without doubles. A Sweeper takes no more, until a batch needs longer lists.
///
/// Candidates are some 10 per query among boxes, 30 among meshes, 1,000 where meshes of 5,000 triangles interlock. A
/// round takes a GPU a few milliseconds at most, and next to nothing if unneeded. A query with Query::hits above 1, and
/// any if objects have motions, takes a search for each object in reach, and for each that is moved, or whose mesh is
/// deformed, without bounds; for every object if its sensor's mesh is.
struct Capacity {
  uint32_t queries = 64;
  uint32_t candidates = 0;
  uint32_t rounds = 0;
  uint32_t unresolvedPairs = 0;
  uint32_t searches = 0;
};

/// The answers of a recording as results() has them, by kind; lists of hits do not count.
struct AnswerCounts {
  bool isExecuted = false;             ///< the last recording's commands; else nothing is counted
  std::array<uint32_t, 5> byStatus{};  ///< queries
  std::array<uint32_t, 6> byFlag{};    ///< by bit
  uint32_t of(Status status) const { return byStatus[static_cast<uint32_t>(status)]; }
  /// `flag`: one of Flag.
  uint32_t flagged(uint32_t flag) const { return byFlag[static_cast<size_t>(std::countr_zero(flag))]; }
};

/// Stages, and how they access memory.
struct Access {
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
};

/// Records batches of mode contact. Make one per frame in flight, while loading: each has its own lists. The first one
/// of a Device creates the pipelines, which belong to the Device. Keep the Recorder and the Device until the recorded
/// commands have executed: destructors do not wait.
class RADAR_API Recorder {
 public:
  /// How recorded commands read the buffers of HostGeometry and HostQueries, and write results().
  static constexpr Access kReads{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
  static constexpr Access kWrites{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};

  /// With a copy of the scene of its own. `device` and `scene` outlive it. Throws, naming the member, if the device's
  /// buffers cannot hold `capacity`; and with reasons if the device answers known queries wrongly.
  Recorder(const Device& device, const Scene& scene, const Capacity& capacity = {});
  /// With a copy that it shares.
  explicit Recorder(SceneCopy& copy, const Capacity& capacity = {});
  ~Recorder();
  Recorder(Recorder&&) noexcept;
  Recorder& operator=(Recorder&&) noexcept;

  /// Records the search into `commands`, a primary or secondary command buffer of HostDevice::queueFamily in the
  /// recording state, outside a render pass. Reads `scene`, `queries` and `geometry` now and not later; the host's
  /// buffers that `geometry` names are read when the commands execute. If anything in these leaves its bounds, is not
  /// finite or too large for floats, every answer becomes Status::invalid with Flag::bounds.
  ///
  /// - Before: the previous recording of this object has executed and been waited for. Writes to the buffers of
  ///   `geometry` are visible to kReads; the next writes to them wait for its stage. Without `geometry` nothing needs
  ///   to be made visible.
  /// - Afterwards: submit the commands once or never; if never, call reset() before the next record(), which else
  ///   throws. Readers of results() wait for kWrites.
  /// - Disturbed: the bound compute pipeline, descriptor set 0 of the compute bind point, and push constants.
  /// - Allocates device memory only if the scene, the geometry or the lists of excluded objects have grown since.
  ///
  /// Throws before recording anything if a query breaks its contract, or asks for what only the CPU combines, and so a
  /// Sweeper answers: skipOverlapping, closest and exit; turns and cutters; a direction while objects move; a clearance
  /// with ignoreLeaving, hits or a step.
  /// Likewise if there are more queries or searches than Capacity says, a query has more than 2^15 objects in reach,
  /// `geometry` breaks its contract, or something does not fit the device.
  void record(VkCommandBuffer commands, std::span<const Query> queries, const HostGeometry& geometry = {});
  /// The same for queries that the host's shaders write; they are read when the commands execute. An answer that
  /// shaders read may be left to read() as above. Answers beyond the number of queries, up to
  /// HostQueries::count, become Status::invalid with Flag::query, as do queries that break the contract of HostQuery.
  /// Matrices of nothing but subnormal floats are out of range, too.
  ///
  /// - Before: writes to the buffers of `queries` are visible to kReads; the next writes to them wait for its stage.
  /// - Allocates device memory also if the queries' span has grown. The first such recording of a Device, be it of no
  ///   query, creates a pipeline.
  ///
  /// Throws before recording anything if there is no buffer of queries, their stride is shorter than a HostQuery, there
  /// may be more than Capacity::queries, an object of the scene has a motion, `geometry` breaks its contract, or
  /// something does not fit the device.
  void record(VkCommandBuffer commands, const HostQueries& queries, const HostGeometry& geometry = {});
  /// Does before the first frame what record() with these arguments would do: makes room, so that record() then creates
  /// nothing on the device, unless the scene changes, and, if there is a queue, uploads the scene and waits. Call it
  /// when record() may be called; nothing is recorded. Throws as record() does. For compiling, see prepare() of a
  /// Device.
  void prepare(std::span<const Query> queries, const HostGeometry& geometry = {});
  void prepare(const HostQueries& queries, const HostGeometry& geometry = {});
  /// Declares that the last recording has not executed and will not.
  void reset();

  /// The answers on the device: one buffer for storage and transfer, owned by the engine; the same as long as this
  /// object lives. It begins with a Result per query, in their order, with the bits of Sweeper::run unless it is open
  /// until read() decides it.
  ///
  /// An answer with Flag::unresolved is open: pairs are too close for the device. `t` is `lo`, before which there is no
  /// contact. If some contact is certain, the status is hit: t* lies in [lo, hi], and object and triangles are the
  /// least of those that certainly touch by hi, though read() may name others. Else it is undecided, `hi` is infinite
  /// and `fraction` is absent. Point and normal are absent (NaN), as is the point of any overlap.
  ///
  /// With a clearance, all hits are open, except decisions (`anyHit`). If something is within the clearance at the
  /// start, the answer is overlap without object, triangles, point and normal. A bracket that rounding keeps wider than
  /// the tolerance may begin before that of a Sweeper, which then searches on the CPU.
  VkBuffer results() const;
  /// Where the last recording's lists of hits (Query::hits) are in results(), in answers: one number per query, and the
  /// end of the last list. Each list has the nearest first, then clear answers. Objects whose contacts are less than a
  /// rounding apart are ordered by t as given, then by number, and a step's answer is the first of them. Entries that
  /// are invalid come first, and those that are open stand where their `lo` belongs.
  std::span<const uint32_t> hitOffsets() const;

  /// The answers on the CPU, one per recorded query (of a host's queries, as many as count), with open ones decided,
  /// and lists; Result::flags tell what is missing, instead of reasons, and there are no statistics. Call it once the
  /// last recording has executed and been waited for (by a fence, or a semaphore's wait on the host); it does not wait
  /// itself, and throws if they have not been executed. Later changes of the scene do not matter.
  Answers read();
  /// How many answers the last recording has of each kind. Decides none, and so takes next to no time. To be called
  /// when read() may be, or if the commands may never have been executed.
  AnswerCounts answerCounts() const;
  /// What the last recording needed, to be called when read() may be: a list's length may differ by some percent when
  /// the same is recorded again. Where the need is unknown because a limit was exceeded: four times as many candidates,
  /// twice as many rounds. A query that exceeded a limit of which this asks no more is for a Sweeper only: by itself it
  /// has more than 16,384 unresolved pairs, or takes more than 64 rounds.
  Capacity needed() const;
  /// If Flag::bounds is set, describes something that has left its bounds; else empty. Call it when read() may be
  /// called.
  std::string boundsViolation() const;
  /// Bytes of its buffers on the device, and of its copy of the scene, unless others share that.
  uint64_t memoryUse() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace radar
