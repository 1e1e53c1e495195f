#include "soft/soft_shadows.h"
