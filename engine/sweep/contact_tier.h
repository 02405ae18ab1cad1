// Mode contact: where a search goes, to the device or to the processor's cores, and in which submissions. Both give the
// same answers, to the bit.
#pragma once

#include "contact/submitter.h"
#include "cpu/search.h"
#include "sweep/asked.h"

namespace radar {

class ContactTier {
 public:
  /// `kernels`: null: the device's, made here unless isOnCpu().
  ContactTier(const Device::Impl& device, const Scene& scene, const SweeperOptions& options, GpuScene& resident,
              std::shared_ptr<const ContactKernels> kernels, const SearchRoom& room, Asked& batch);

  /// Whether all batches are answered on the CPU, so that the device needs no scene.
  bool isOnCpu() const;
  /// Plans these queries and submits them; on return the last submission may still be with the device.
  void run(std::span<const size_t> which);
  /// Waits for it, and sees to what the device had no room or range for.
  void finish();

 private:
  void submit();
  void land();
  void decode(const SearchAnswers& found, std::span<const size_t> landing);
  void answerOnCpu(std::span<const size_t> which);

  const Device::Impl& device_;
  const Scene& scene_;
  const SweeperOptions options_;
  GpuScene& resident_;
  std::shared_ptr<const ContactKernels> kernels_;
  const SearchRoom room_;
  const size_t mostSensors_;  ///< of one submission
  Asked& batch_;
  std::optional<ContactSubmitter> submitter_;  ///< made when first needed: batches may all be small
  cpu::Search cpu_;
  SensorBatch sensors_;
  std::vector<size_t> planned_, flying_;  ///< the queries of `sensors_`, and those with the device
  std::vector<size_t> cramped_;           ///< those that the device had no room for, and now has
};

}  // namespace radar
