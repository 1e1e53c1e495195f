#include "ao/ambient_occlusion.h"
