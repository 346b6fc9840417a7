#include <chrono>
#include <cstdio>
#include "orbweaver/archive/read/reader.hpp"
#include "orbweaver/prove/proof_file.hpp"
#include "orbweaver/refine/stored_family.hpp"
using namespace orbweaver;
int main(int argc,char**argv){
  const archive::Archive atlas(argv[1]);
  const auto family=refine::StoredFamily::named(atlas,argv[2]);
  std::string held=argv[3];
  int digits=argc>4?atoi(argv[4]):30;
  refine::HeldValue h{held[0]=='T'?refine::HeldValue::Quantity::period:refine::HeldValue::Quantity::energy,held.substr(2)};
  try{
  const auto place=family.with(h,argc>5?std::optional<int>(atoi(argv[5])):std::nullopt);
  auto t0=std::chrono::steady_clock::now();
  auto sec=[&]{return std::chrono::duration<double>(std::chrono::steady_clock::now()-t0).count();};
  const auto st=prove::statement_about(argv[2],{},place.guess,h,digits);
  printf("statement %.2f s; %zu unknowns, %zu segments, %ld bits\n",sec(),st.centre.size(),st.fractions.size(),st.bits);
  const auto p=prove::prove(st);
  printf("%s\n radius %.3e distance %.3e order %d taylor %d steps %ld  %s\n",p.isolated_by.c_str(),p.radius,p.distance,p.order,p.taylor_order,p.steps,name_of(p.stability));
  for(auto&e:p.state)printf("  %s\n",e.text().c_str());
  printf(" T %s\n E %s\n",p.period.text().c_str(),p.energy.text().c_str());
  if(p.index)printf(" kf %s\n k %s\n",p.fundamental_index->text().c_str(),p.index->text().c_str());
  for(auto&e:p.multiplier)printf("  mu %s\n",e.text().c_str());
  printf("%.2f s\n",sec());
  prove::write_proofs("/tmp/w/prove_x.h5",{p});for(auto&m:prove::check(prove::read_proofs("/tmp/w/prove_x.h5")[0]))printf("MISSING %s\n",m.c_str());printf("%.2f s\n",sec());
  }catch(const std::exception&e){printf("FAILED %s\n",e.what());return 1;}
}
