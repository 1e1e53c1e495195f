layout(location = 0) out uint o_id;

void main() { o_id = uint(gl_PrimitiveID); }
