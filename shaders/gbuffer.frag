in vec3 v_normal;
layout(location = 0) out uint o_id;
layout(location = 1) out uint o_normal;

void main() {
  o_id = uint(gl_PrimitiveID);
  o_normal = pack_normal(v_normal);
}
