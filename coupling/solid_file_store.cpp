#include "coupling/solid_file_store.h"

#include "coupling/solid_files.h"

namespace spume::coupling {

std::shared_ptr<SolidFileStore> makeSolidFileStore() { return std::make_shared<SolidFileStore>(); }

std::shared_ptr<const DistanceField> SolidFileStore::distance(const ShapeSpec& shape, double dx,
                                                              double longest) {
  const std::lock_guard lock(mutex_);
  std::shared_ptr<const DistanceField>& field = fields_[{shape.kind, shape.file, shape.scale, dx, longest}];
  if (!field) field = std::make_shared<const DistanceField>(distanceFromFile(shape, dx, longest));
  return field;
}

}  // namespace spume::coupling
