// Receives the hours of sensors from the calculation of `troffer annual`: adds them to the means of
// grids, to eyes and to groups of electric light, and writes arrays.
#pragma once

#include <memory>
#include <vector>

#include "annual/annual_report.h"
#include "annual/honeybee_folder.h"

namespace troffer {

class AnnualSink {
 public:
  // folder: for arrays. grids, eyes: filled in; eyes are the points behind those of grids.
  AnnualSink(std::string folder, ArrayFormat format, const std::vector<LightPath>& paths,
             std::vector<AnnualGrid>& grids, std::vector<EyeYear>& eyes, DimmingYear& dimming)
      : folder_(std::move(folder)),
        format_(format),
        paths_(paths),
        grids_(grids),
        eyes_(eyes),
        dimming_(dimming) {}

  void take(size_t sensor, const HoursOfSensor& hours);
  HoneybeeFolder* arrays() { return arrays_.get(); }  // null: nothing came

 private:
  void open(size_t hours);

  std::string folder_;
  ArrayFormat format_;
  const std::vector<LightPath>& paths_;
  std::vector<AnnualGrid>& grids_;
  std::vector<EyeYear>& eyes_;
  DimmingYear& dimming_;
  size_t grid_ = 0;
  std::unique_ptr<HoneybeeFolder> arrays_;
};

}  // namespace troffer
